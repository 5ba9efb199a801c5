/// \file Checks that a study's chain, seal, schedule, payloads and pack are consistent.
#pragma once

#include "core/public_keys.hpp"
#include "engine/pack/pack.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

enum class CheckState { passed, failed, not_checked };
/// "passed", "failed", "not-checked"
[[nodiscard]] std::string name_of(CheckState state);

struct Check {
  std::string name;  ///< "chain", "key", "seal", "configuration", ...
  CheckState state = CheckState::not_checked;
  std::string detail;  ///< one line: what was checked, or what is wrong and where
};

struct Verification {
  bool simulated = false;
  std::vector<Check> checks;
  /// The end of the file's chain. A copy kept elsewhere can show that nothing was cut off.
  std::optional<record::ChainHead> head;
  PublicKey investigator{};  ///< the investigator of the first event, whose signatures are checked
  /// Remarks that are not faults: chain_notes.
  std::vector<std::string> notes{};

  /// Whether no check failed. A check that was not made does not count as failed.
  [[nodiscard]] bool holds() const noexcept;
  /// Whether every check was made.
  [[nodiscard]] bool complete() const noexcept;
};

/// Verifies a study. Inconsistent evidence never throws: it is a failed check, which names the
/// first place. The checks are, in order: chain; key; seal, configuration and schedule (these need
/// the key); responses; payloads and traces (these need the key); pack (more thorough with the
/// key); head, if one is given. The result reveals nothing about outcomes, so a running study may
/// be verified.
/// \param key,pack  null: checks that need it are skipped
/// \param head  a hash, or its first digits, that was once the end of the file's chain and must
///   still be on the chain; empty: none
[[nodiscard]] Verification verify_study(const record::StudyStore& store, const study::StudyKey* key,
                                        const engine::Pack* pack, const std::string& head = {});

/// One JSON object, indented, ending with a line feed.
[[nodiscard]] std::string verification_json(const Verification& verification);

/// One line for each check, ending with a line feed.
[[nodiscard]] std::string verification_text(const Verification& verification);

}  // namespace touchtrial::analysis

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
  /// The end of the file's chain. A copy stored elsewhere can show that nothing was cut off.
  std::optional<record::ChainHead> head;
  PublicKey investigator{};  ///< from the first event; checks signatures
  /// Remarks that are not faults, see chain_notes.
  std::vector<std::string> notes{};

  /// Whether no check failed. Skipped checks do not count as failed.
  [[nodiscard]] bool holds() const noexcept;
  /// Whether every check was made.
  [[nodiscard]] bool complete() const noexcept;
};

/// Verifies a study. Inconsistent evidence never throws; it is a failed check that names the first
/// inconsistency. The checks are, in order: chain, key, seal, configuration, schedule, responses,
/// payloads, traces, pack, and head if one is given. All but chain, pack and head need the key;
/// pack is more thorough with the key. The result reveals nothing about outcomes, so a running
/// study may be verified.
/// \param key,pack  null: checks that need it are skipped
/// \param head  a hash, or its first digits, that was once the end of the file's chain and must
///   still be on the chain; empty: no check
[[nodiscard]] Verification verify_study(const record::StudyStore& store, const study::StudyKey* key,
                                        const engine::Pack* pack, const std::string& head = {});

/// One indented JSON object, ending with a line feed.
[[nodiscard]] std::string verification_json(const Verification& verification);

/// One line per check, then the file's chain, the investigator, notes and skipped checks.
[[nodiscard]] std::string verification_text(const Verification& verification);

}  // namespace touchtrial::analysis

/// \file Chain, seal, schedule, payloads and pack of a study, held against each other.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

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
  std::string detail;  ///< one line: what was held against what, or what does not hold and where
};

struct Verification {
  bool simulated = false;
  std::vector<Check> checks;
  /// Where the file's chain ends; whoever keeps it elsewhere can show that nothing was cut off.
  std::optional<store::ChainHead> head;

  /// Whether nothing failed; what could not be checked does not fail.
  [[nodiscard]] bool holds() const noexcept;
  /// Whether every check was made.
  [[nodiscard]] bool complete() const noexcept;
};

/// Never throws for evidence that does not hold: that is a failed check, which names the first
/// place. In order: chain; key; seal, configuration, schedule (these with the key); responses;
/// payloads, traces (with the key); pack (better with the key); head, if one is given. Tells
/// nothing of outcomes: it may be used on a running study. \param key,pack  null: the checks that
/// need it are not made \param head  a hash that was once the end of the file's chain, which must
/// still be on it
[[nodiscard]] Verification verify_study(const store::StudyStore& store, const design::StudyKey* key,
                                        const engine::Pack* pack,
                                        const std::optional<Digest>& head = {});

/// One JSON object, indented, ending with a line feed.
[[nodiscard]] std::string verification_json(const Verification& verification);

/// One line a check, ending with a line feed.
[[nodiscard]] std::string verification_text(const Verification& verification);

}  // namespace touchtrial::analysis

/// \file The trials that count, by method and participant. Private to analysis/report.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/confusion.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// One participant's trials with one method, by number. They point into the outcomes.
using OwnTrials = std::vector<const TrialOutcome*>;

struct CountedTrials {
  std::vector<std::string> participants;       ///< whose session counts, by session
  std::vector<std::vector<OwnTrials>> trials;  ///< [method][participant]; may be empty
};

/// \param outcomes  must outlive the result
[[nodiscard]] CountedTrials counted_by_method(const Outcomes& outcomes);

[[nodiscard]] Choice choice_of(const TrialOutcome& trial);
[[nodiscard]] Proportion accuracy_of(const OwnTrials& trials);
/// Of the trials that presented one class.
[[nodiscard]] OwnTrials of_class(const OwnTrials& trials, int class_index);

/// Whether a trial came to an end that counts: an answer, or the time's end without one.
[[nodiscard]] bool has_ended(const TrialOutcome& trial) noexcept;

}  // namespace touchtrial::analysis::identification

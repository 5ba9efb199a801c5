/// \file The trials that count, by method and participant. Private to
/// protocols/identification/analysis.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/statistics/confusion.hpp"

#include <map>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

/// One participant's trials with one method, ordered by trial number. The pointers refer to the
/// outcomes.
using OwnTrials = std::vector<const TrialOutcome*>;

struct CountedTrials {
  std::vector<std::string> participants;       ///< whose session counts, in session order
  std::vector<std::vector<OwnTrials>> trials;  ///< [method][participant]; may be empty
};

/// \param outcomes  must outlive the result
[[nodiscard]] CountedTrials counted_by_method(const Outcomes& outcomes);

/// Whose sessions are whose. The first session of a participant stands for the participant; in a
/// study with one visit, every session stands for itself.
class People {
 public:
  explicit People(const Outcomes& outcomes);

  [[nodiscard]] int of(int session) const {
    const auto found = first_.find(session);
    return found == first_.end() ? session : found->second;
  }

 private:
  std::map<int, int> first_;  ///< of participants with several sessions
};

/// All participants' trials with one method.
[[nodiscard]] ConfusionMatrix confusion_of(const Outcomes& outcomes, int method);

[[nodiscard]] Choice choice_of(const TrialOutcome& trial);
[[nodiscard]] Proportion accuracy_of(const OwnTrials& trials);
/// The trials that presented one class.
[[nodiscard]] OwnTrials of_class(const OwnTrials& trials, int class_index);

/// All presentations that are not void, in the order in which they were felt. An interrupted trial
/// stands where it was repeated; what the participant felt before the interruption does not appear.
[[nodiscard]] std::vector<const TrialOutcome*> as_felt(const Outcomes& outcomes);

/// Tells whether a trial ended in a way that counts: with an answer, or by a time-out.
[[nodiscard]] bool has_ended(const TrialOutcome& trial) noexcept;

}  // namespace touchtrial::analysis::identification

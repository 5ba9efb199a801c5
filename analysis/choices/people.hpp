/// \file People and their trials, in studies whose answers are right or wrong.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/proportion.hpp"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace touchtrial::choices {

using analysis::Interval;
using analysis::MeanEstimate;
using analysis::Outcomes;
using analysis::Proportion;
using analysis::SessionOutcome;
using analysis::TrialOutcome;

/// Some trials of one participant. The pointers refer to the outcomes.
using OwnTrials = std::vector<const TrialOutcome*>;

/// A participant whose session counts.
struct Person {
  std::string name;
  OwnTrials trials;  ///< of sessions that count
};

/// The people of a study with the selected trials.
/// \param outcomes  must outlive the result
/// \return in the order of sessions, including people without a trial; trials in the order of the
///   outcomes
[[nodiscard]] std::vector<Person> people_with(
    const Outcomes& outcomes, const std::function<bool(const TrialOutcome&)>& is_wanted);

/// Sorts trials by when they were felt. An interrupted trial takes the place of its repetition.
void sort_as_felt(OwnTrials& trials);

/// All presentations that are not void, in the order in which they were felt. Interrupted
/// presentations are left out.
[[nodiscard]] OwnTrials as_felt(const Outcomes& outcomes);

/// Maps sessions to participants, who are identified by their first session. In a study with one
/// visit, every session maps to itself.
class FirstSessions {
 public:
  explicit FirstSessions(const Outcomes& outcomes);

  [[nodiscard]] int of(int session) const {
    const auto found = first_.find(session);
    return found == first_.end() ? session : found->second;
  }

 private:
  std::map<int, int> first_;  ///< of participants with several sessions
};

[[nodiscard]] std::set<int> counted_sessions(const Outcomes& outcomes);

/// Completed sessions that would count if they were not excluded. A participant who was excluded
/// and started again is left out, because the new session counts already.
[[nodiscard]] std::set<int> excluded_sessions(const Outcomes& outcomes);

[[nodiscard]] Proportion accuracy_of(const OwnTrials& trials);

/// Whether a trial ended in a way that counts: with an answer, or by a time-out.
[[nodiscard]] bool has_ended(const TrialOutcome& trial) noexcept;

}  // namespace touchtrial::choices

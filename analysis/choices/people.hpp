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

/// Trials of one participant; pointers into the outcomes.
using PersonTrials = std::vector<const TrialOutcome*>;

/// A participant with a counted session.
struct Person {
  std::string name;
  PersonTrials trials;  ///< of counted sessions
};

/// \param outcomes  must outlive the result
/// \return people in the order of sessions, including those without a selected trial; trials in the
///   order of the outcomes
[[nodiscard]] std::vector<Person> people_with_trials(
    const Outcomes& outcomes, const std::function<bool(const TrialOutcome&)>& is_included);

/// Sorts trials by the time they were felt. An interrupted trial has the time of its repetition.
void sort_in_felt_order(PersonTrials& trials);

/// All presentations except void and interrupted ones, in the order in which they were felt.
[[nodiscard]] PersonTrials trials_in_felt_order(const Outcomes& outcomes);

/// Maps each session to its participant's first session, which identifies the participant. With one
/// visit, every session maps to itself.
class FirstSessions {
 public:
  explicit FirstSessions(const Outcomes& outcomes);

  [[nodiscard]] int first_of(int session) const {
    const auto found = first_.find(session);
    return found == first_.end() ? session : found->second;
  }

 private:
  std::map<int, int> first_;  ///< of participants with several sessions
};

[[nodiscard]] std::set<int> counted_sessions(const Outcomes& outcomes);

/// Completed sessions that would count if they were not excluded. Omits participants who were
/// excluded and started again, because their new session counts.
[[nodiscard]] std::set<int> excluded_sessions(const Outcomes& outcomes);

[[nodiscard]] Proportion accuracy_of(const PersonTrials& trials);

/// Whether a trial ended with an answer or a time-out.
[[nodiscard]] bool has_ended(const TrialOutcome& trial) noexcept;

}  // namespace touchtrial::choices

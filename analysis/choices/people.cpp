#include "analysis/choices/people.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace touchtrial::choices {

std::vector<Person> people_with_trials(
    const Outcomes& outcomes, const std::function<bool(const TrialOutcome&)>& is_included) {
  std::vector<Person> people;
  std::map<std::string, std::size_t> index_by_name;
  for (const SessionOutcome& session : outcomes.sessions) {
    const std::string& name = session.row.participant;
    if (session.counted && index_by_name.emplace(name, people.size()).second)
      people.push_back({name, {}});
  }
  const std::set<int> counted = counted_sessions(outcomes);
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!counted.contains(trial.row.session) || !is_included(trial)) continue;
    people[index_by_name.at(trial.participant)].trials.push_back(&trial);
  }
  return people;
}

void sort_in_felt_order(PersonTrials& trials) {
  std::ranges::stable_sort(trials, {}, [](const TrialOutcome* trial) {
    return std::tuple(trial->row.session, trial->row.presented_at, trial->row.trial);
  });
}

PersonTrials trials_in_felt_order(const Outcomes& outcomes) {
  PersonTrials trials;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.row.state != record::TrialState::voided) trials.push_back(&trial);
  }
  sort_in_felt_order(trials);
  return trials;
}

FirstSessions::FirstSessions(const Outcomes& outcomes) {
  if (outcomes.design.visits.count == 1) return;
  std::map<std::pair<std::string, int>, int> first;  // by participant and enrolment number
  for (const SessionOutcome& session : outcomes.sessions) {
    const std::pair person(session.row.participant, session.row.enrolment);
    first_[session.row.session] = first.try_emplace(person, session.row.session).first->second;
  }
}

std::set<int> counted_sessions(const Outcomes& outcomes) {
  std::set<int> counted;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (session.counted) counted.insert(session.row.session);
  }
  return counted;
}

std::set<int> excluded_sessions(const Outcomes& outcomes) {
  std::set<int> excluded;
  for (const SessionOutcome& session : outcomes.sessions) {
    const record::SessionRow& row = session.row;
    const bool is_left_out = row.excluded && !row.erased && row.replaced_by != row.participant;
    const bool is_of_study = row.pilot == outcomes.pilot && row.simulated == outcomes.simulated;
    if (is_left_out && is_of_study && row.state == record::SessionState::completed)
      excluded.insert(row.session);
  }
  return excluded;
}

Proportion accuracy_of(const PersonTrials& trials) {
  const auto correct = std::ranges::count_if(trials, &TrialOutcome::correct);
  return {static_cast<int>(trials.size()), static_cast<int>(correct)};
}

bool has_ended(const TrialOutcome& trial) noexcept {
  return trial.row.state == record::TrialState::answered ||
         trial.row.state == record::TrialState::timed_out;
}

}  // namespace touchtrial::choices

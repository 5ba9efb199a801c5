#include "protocols/identification/analysis/counted_trials.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace touchtrial::analysis::identification {

CountedTrials counted_by_method(const Outcomes& outcomes) {
  CountedTrials counted;
  std::map<std::string, std::size_t> place;
  for (const SessionOutcome& session : outcomes.sessions) {
    const std::string& name = session.row.participant;
    if (session.counted && place.emplace(name, counted.participants.size()).second) {
      counted.participants.push_back(name);
    }
  }
  counted.trials.assign(outcomes.methods.size(),
                        std::vector<OwnTrials>(counted.participants.size()));
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.counted) continue;
    counted.trials[trial.stimulus.method][place.at(trial.participant)].push_back(&trial);
  }
  return counted;
}

People::People(const Outcomes& outcomes) {
  if (outcomes.design.visits.count == 1) return;
  std::map<std::pair<std::string, int>, int> first;  // by participant and enrolment number
  for (const SessionOutcome& one : outcomes.sessions) {
    const std::pair person(one.row.participant, one.row.enrolment);
    first_[one.row.session] = first.try_emplace(person, one.row.session).first->second;
  }
}

ConfusionMatrix confusion_of(const Outcomes& outcomes, int method) {
  ConfusionMatrix confusion(static_cast<int>(outcomes.classes.size()));
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.counted && trial.stimulus.method == method) confusion.add(choice_of(trial));
  }
  return confusion;
}

Choice choice_of(const TrialOutcome& trial) {
  return {trial.stimulus.class_index, trial.response};
}

Proportion accuracy_of(const OwnTrials& trials) {
  const auto correct = std::ranges::count_if(trials, &TrialOutcome::correct);
  return {static_cast<int>(trials.size()), static_cast<int>(correct)};
}

OwnTrials of_class(const OwnTrials& trials, int class_index) {
  OwnTrials own;
  std::ranges::copy_if(trials, std::back_inserter(own), [class_index](const TrialOutcome* trial) {
    return trial->stimulus.class_index == class_index;
  });
  return own;
}

std::vector<const TrialOutcome*> as_felt(const Outcomes& outcomes) {
  std::vector<const TrialOutcome*> felt;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.row.state != record::TrialState::voided) felt.push_back(&trial);
  }
  std::ranges::stable_sort(felt, {}, [](const TrialOutcome* trial) {
    return std::tuple(trial->row.session, trial->row.presented_at, trial->row.trial);
  });
  return felt;
}

bool has_ended(const TrialOutcome& trial) noexcept {
  return trial.row.state == record::TrialState::answered ||
         trial.row.state == record::TrialState::timed_out;
}

}  // namespace touchtrial::analysis::identification

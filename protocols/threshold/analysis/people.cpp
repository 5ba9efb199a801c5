#include "protocols/threshold/analysis/report_parts.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace touchtrial::analysis::threshold {

bool in_track(const TrialOutcome& trial) noexcept {
  return trial.kind == design::PresentationKind::scored && trial.chosen && trial.chosen->track > 0;
}

bool in_control(const TrialOutcome& trial) noexcept {
  return trial.kind == design::PresentationKind::lead_in;
}

std::vector<Person> people_of(const Outcomes& outcomes) {
  std::vector<Person> people;
  std::map<std::string, std::size_t> place;
  std::set<int> counted;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (!session.counted) continue;
    counted.insert(session.row.session);
    const std::string& name = session.row.participant;
    if (place.emplace(name, people.size()).second) people.push_back({name, {}});
  }
  for (const TrialOutcome& trial : outcomes.trials) {
    const auto person = place.find(trial.participant);
    if (person == place.end() || !counted.contains(trial.row.session)) continue;
    const bool ended = trial.chosen && trial.response && trial.right &&
                       trial.row.state == store::TrialState::answered;
    if (ended) people[person->second].trials.push_back(&trial);
  }
  for (Person& person : people) {
    std::ranges::stable_sort(person.trials, {}, [](const TrialOutcome* trial) {
      return std::tuple(trial->row.session, trial->row.presented_at, trial->row.trial);
    });
  }
  return people;
}

}  // namespace touchtrial::analysis::threshold

#include "protocols/threshold/analysis/report.hpp"

#include "protocols/threshold/analysis/report_parts.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace touchtrial::analysis::threshold {
namespace {

using study::threshold::Question;

/// Trials of tracks in sessions that count, which the participant did not answer.
int tracks_trials_without_answer(const Outcomes& outcomes) {
  int n = 0;
  for (const TrialOutcome& trial : outcomes.trials) {
    n += trial.counted && in_track(trial) && !trial.response ? 1 : 0;
  }
  return n;
}

ThresholdReport begun_report(const Outcomes& outcomes) {
  ThresholdReport report;
  static_cast<StudyHead&>(report) = head_of(outcomes);
  report.design = outcomes.design;
  report.choices = outcomes.choices;
  const study::threshold::ThresholdOptions& options = report.options();
  const procedures::ParameterGrid& grid = options.track.grid;
  report.guess =
      options.question == Question::same_different ? 0.5 : 1.0 / std::max(options.intervals, 2);
  if (options.question != Question::same_different) {
    report.criterion = grid.guess + (1.0 - grid.guess) * procedures::share_at_threshold(grid.shape);
  }
  report.by_posterior = options.track.procedure != "constant-stimuli";
  report.without_answer = tracks_trials_without_answer(outcomes);
  return report;
}

}  // namespace

bool in_track(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::scored && trial.chosen && trial.chosen->track > 0;
}

bool in_control(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::control;
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
                       trial.row.state == record::TrialState::answered;
    if (ended) people[person->second].trials.push_back(&trial);
  }
  for (Person& person : people) {
    std::ranges::stable_sort(person.trials, {}, [](const TrialOutcome* trial) {
      return std::tuple(trial->row.session, trial->row.presented_at, trial->row.trial);
    });
  }
  return people;
}

ThresholdReport make_report(const Outcomes& outcomes, int jobs) {
  ThresholdReport report = begun_report(outcomes);
  const std::vector<Person> people = people_of(outcomes);
  report.tracks = track_reports(report.design, people, report.by_posterior, jobs);
  report.standards = standard_reports(report);
  report.differences = difference_reports(report.standards);
  report.control = control_of(people, report.guess);
  report.catches = catches_of(people, report.guess);
  report.choice_use = choice_use_of(people, report.choices);
  report.after_right = repetition_of(people, true);
  report.after_wrong = repetition_of(people, false);
  report.learning_db = group_learning(report);
  report.same_different = same_different_levels(report.design, people);
  report.same_different_groups = same_different_groups(report.same_different);
  report.warnings = threshold_warnings(report);
  return report;
}

}  // namespace touchtrial::analysis::threshold

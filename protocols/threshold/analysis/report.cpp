#include "protocols/threshold/analysis/report.hpp"

#include "analysis/outcomes/departures.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "protocols/threshold/analysis/primary.hpp"

#include <algorithm>

namespace touchtrial::analysis::threshold {
namespace {

using choices::Person;
using study::threshold::Question;

/// Unanswered trials of tracks in counted sessions.
int trials_without_answer(const Outcomes& outcomes) {
  int n = 0;
  for (const TrialOutcome& trial : outcomes.trials) {
    n += trial.counted && is_track_trial(trial) && !trial.response ? 1 : 0;
  }
  return n;
}

ThresholdReport initial_report(const Outcomes& outcomes) {
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
  report.without_answer = trials_without_answer(outcomes);
  return report;
}

StandardReport standard_report(const ThresholdReport& report, std::size_t standard,
                               const study::threshold::Standard& definition) {
  StandardReport result;
  result.definition = definition;
  result.words = study::threshold::words_of(report.design, definition);
  result.levels = study::threshold::levels_of(report.options(), definition);
  std::vector<std::vector<procedures::ThresholdEstimate>> tracks;
  for (const TrackReport& track : report.tracks) {
    if (track.standard != standard) continue;
    ++result.tracks;
    if (!track.estimate) continue;
    if (result.people.empty() || result.people.back() != track.participant) {
      result.people.push_back(track.participant);
      tracks.emplace_back();
    }
    tracks.back().push_back(*track.estimate);
  }
  for (const auto& person_tracks : tracks) {
    result.thresholds.push_back(person_threshold(person_tracks, result.levels));
  }
  result.mean = mean_of(result.thresholds);
  return result;
}

std::vector<PersonThreshold> paired_differences(const StandardReport& first,
                                                const StandardReport& second) {
  std::vector<PersonThreshold> differences;
  for (std::size_t i = 0; i < first.people.size(); ++i) {
    const auto match = std::ranges::find(second.people, first.people[i]);
    if (match == second.people.end()) continue;
    const auto place = static_cast<std::size_t>(match - second.people.begin());
    differences.push_back(difference_of(first.thresholds[i], second.thresholds[place]));
  }
  return differences;
}

std::vector<StandardReport> standard_reports(const ThresholdReport& report) {
  std::vector<StandardReport> all;
  for (const study::threshold::Standard& standard : study::threshold::standards_of(report.design)) {
    all.push_back(standard_report(report, all.size(), standard));
  }
  return all;
}

std::vector<DifferenceReport> difference_reports(std::span<const StandardReport> standards) {
  std::vector<DifferenceReport> all;
  std::vector<double> p;
  for (std::size_t i = 0; i < standards.size(); ++i) {
    for (std::size_t j = i + 1; j < standards.size(); ++j) {
      const std::vector<PersonThreshold> differences =
          paired_differences(standards[i], standards[j]);
      DifferenceReport& pair = all.emplace_back();
      pair.first = i;
      pair.second = j;
      pair.difference = mean_of(differences);
      pair.known = static_cast<int>(
          std::ranges::count(differences, procedures::Censored::no, &PersonThreshold::censored));
      pair.p = p_of(differences, 0.0, Sides::two);
      pair.statistic = known_t_statistic(bounds_of(differences));
      if (pair.p) p.push_back(*pair.p);
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (DifferenceReport& pair : all) {
    if (pair.p) pair.p_holm = *next++;
  }
  return all;
}

GroupTest group_learning(const ThresholdReport& report) {
  std::vector<double> means;
  for (auto track = report.tracks.begin(); track != report.tracks.end();) {
    const std::string& participant = track->participant;
    double sum = 0.0;
    int n = 0;
    for (; track != report.tracks.end() && track->participant == participant; ++track) {
      if (!track->learning_db) continue;
      sum += *track->learning_db;
      ++n;
    }
    if (n > 0) means.push_back(sum / n);
  }
  return choices::group_test(means);
}

}  // namespace

bool is_track_trial(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::scored && trial.chosen && trial.chosen->track > 0;
}

bool is_catch(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::catch_trial && trial.chosen && trial.chosen->track > 0;
}

bool is_control_trial(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::control;
}

bool is_answer(const TrialOutcome& trial) noexcept {
  return trial.chosen && trial.response && trial.right &&
         trial.row.state == record::TrialState::answered;
}

std::vector<Person> people_of(const Outcomes& outcomes) {
  std::vector<Person> people = choices::people_with_trials(outcomes, is_answer);
  for (Person& person : people) choices::sort_in_felt_order(person.trials);
  return people;
}

ThresholdReport make_report(const Outcomes& outcomes, int jobs) {
  ThresholdReport report = initial_report(outcomes);
  const std::vector<Person> people = people_of(outcomes);
  report.tracks = track_reports(report.design, people, jobs);
  report.standards = standard_reports(report);
  report.differences = difference_reports(report.standards);
  report.control = sound_report(people, report.guess, report.standards);
  report.catches = choices::test_against_guessing(people, report.guess, is_catch);
  if (report.catches) report.attention = choices::attention_of(*report.catches);
  report.choice_use = choices::choice_use_of(people, report.choices, is_track_trial);
  if (report.options().question != Question::same_different) {
    report.preferences = choices::preferences_by_target(
        people, static_cast<int>(report.choices.size()), is_track_trial);
  }
  report.after_right = choices::repetition_of(people, true, is_track_trial);
  report.after_wrong = choices::repetition_of(people, false, is_track_trial);
  report.learning_db = group_learning(report);
  report.same_different = same_different_levels(report.design, people);
  report.same_different_groups = same_different_groups(report.same_different);
  report.primary = primary_result(outcomes, report, jobs);
  if (report.primary && report.primary->ended_at_look) {
    report.departures = departures_of(outcomes, true);
  }
  report.warnings = threshold_warnings(report);
  return report;
}

int StandardReport::number_of(procedures::Censored censored) const {
  return static_cast<int>(std::ranges::count(thresholds, censored, &PersonThreshold::censored));
}

procedures::Threshold mean_threshold(const CensoredMean& mean) {
  procedures::Threshold threshold;
  threshold.level = mean.mean;
  if (mean.interval) {
    threshold.low = mean.interval->low;
    threshold.high = mean.interval->high;
  }
  return threshold;
}

}  // namespace touchtrial::analysis::threshold

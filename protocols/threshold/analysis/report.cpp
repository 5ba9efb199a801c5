#include "protocols/threshold/analysis/report.hpp"

#include "analysis/outcomes/departures.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "protocols/threshold/analysis/primary.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace touchtrial::analysis::threshold {
namespace {

using choices::Person;
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
  report.without_answer = tracks_trials_without_answer(outcomes);
  return report;
}

/// The mean of the levels of each participant, in the order in which they first appear.
class MeanOfEach {
 public:
  void add(const std::string& participant, double value) {
    const auto [found, is_new] = place_.emplace(participant, people.size());
    if (is_new) {
      people.push_back(participant);
      sums_.push_back({0.0, 0});
    }
    sums_[found->second].first += value;
    ++sums_[found->second].second;
  }
  [[nodiscard]] std::vector<double> means() const {
    std::vector<double> all;
    for (const auto& [sum, n] : sums_) all.push_back(sum / n);
    return all;
  }
  std::vector<std::string> people;

 private:
  std::map<std::string, std::size_t> place_;
  std::vector<std::pair<double, int>> sums_;
};

StandardReport standard_report(const ThresholdReport& report, std::size_t standard,
                               const study::threshold::Standard& of) {
  StandardReport result;
  result.of = of;
  result.words = study::threshold::words_of(report.design, of);
  result.levels = study::threshold::levels_of(report.options(), of);
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
  for (const auto& own : tracks) {
    result.thresholds.push_back(person_threshold(own, result.levels));
  }
  result.mean = mean_of(result.thresholds);
  return result;
}

std::vector<PersonThreshold> paired_differences(const StandardReport& first,
                                                const StandardReport& second) {
  std::vector<PersonThreshold> differences;
  for (std::size_t i = 0; i < first.people.size(); ++i) {
    const auto other = std::ranges::find(second.people, first.people[i]);
    if (other == second.people.end()) continue;
    const auto place = static_cast<std::size_t>(other - second.people.begin());
    differences.push_back(difference_of(first.thresholds[i], second.thresholds[place]));
  }
  return differences;
}

std::vector<StandardReport> standard_reports(const ThresholdReport& report) {
  std::vector<StandardReport> all;
  for (const study::threshold::Standard& of : study::threshold::standards_of(report.design)) {
    all.push_back(standard_report(report, all.size(), of));
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
      DifferenceReport& one = all.emplace_back();
      one.first = i;
      one.second = j;
      one.difference = mean_of(differences);
      one.known = static_cast<int>(
          std::ranges::count(differences, procedures::Censored::no, &PersonThreshold::censored));
      one.p = p_of(differences, 0.0, Sides::two);
      one.statistic = known_t_statistic(bounds_of(differences));
      if (one.p) p.push_back(*one.p);
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (DifferenceReport& one : all) {
    if (one.p) one.p_holm = *next++;
  }
  return all;
}

GroupTest group_learning(const ThresholdReport& report) {
  MeanOfEach each;
  for (const TrackReport& track : report.tracks) {
    if (track.learning_db) each.add(track.participant, *track.learning_db);
  }
  return choices::group_test(each.means());
}

}  // namespace

bool in_track(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::scored && trial.chosen && trial.chosen->track > 0;
}

bool is_catch(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::catch_trial && trial.chosen && trial.chosen->track > 0;
}

bool in_control(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::control;
}

bool is_answer(const TrialOutcome& trial) noexcept {
  return trial.chosen && trial.response && trial.right &&
         trial.row.state == record::TrialState::answered;
}

std::vector<Person> people_of(const Outcomes& outcomes) {
  std::vector<Person> people = choices::people_with(outcomes, is_answer);
  for (Person& person : people) choices::sort_as_felt(person.trials);
  return people;
}

ThresholdReport make_report(const Outcomes& outcomes, int jobs) {
  ThresholdReport report = begun_report(outcomes);
  const std::vector<Person> people = people_of(outcomes);
  report.tracks = track_reports(report.design, people, jobs);
  report.standards = standard_reports(report);
  report.differences = difference_reports(report.standards);
  report.control = sound_report(people, report.guess, report.standards);
  report.catches = choices::against_guessing(people, report.guess, is_catch);
  if (report.catches) report.attention = choices::attention_of(*report.catches);
  report.choice_use = choices::choice_use_of(people, report.choices, in_track);
  if (report.options().question != Question::same_different) {
    report.preferences =
        choices::preferences_by_target(people, static_cast<int>(report.choices.size()), in_track);
  }
  report.after_right = choices::repetition_of(people, true, in_track);
  report.after_wrong = choices::repetition_of(people, false, in_track);
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

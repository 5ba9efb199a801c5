#include "protocols/threshold/analysis/report.hpp"

#include "analysis/statistics/paired_tests.hpp"

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
  report.by_posterior = options.track.procedure != "constant-stimuli";
  report.without_answer = tracks_trials_without_answer(outcomes);
  return report;
}

using procedures::Censored;

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

StandardReport standard_report(const ThresholdReport& report, std::size_t standard) {
  StandardReport result;
  MeanOfEach each;
  for (const TrackReport& track : report.tracks) {
    if (track.standard != standard) continue;
    ++result.tracks;
    const std::optional<TrackEstimate>& quoted = report.quoted(track);
    if (!quoted) continue;
    if (quoted->threshold.censored == Censored::below) ++result.censored_below;
    if (quoted->threshold.censored == Censored::above) ++result.censored_above;
    if (quoted->threshold.level) each.add(track.participant, *quoted->threshold.level);
  }
  result.people = each.people;
  result.thresholds = each.means();
  result.mean = choices::unbounded_mean(result.thresholds);
  return result;
}

std::vector<double> paired_differences(const StandardReport& first, const StandardReport& second) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < first.people.size(); ++i) {
    const auto other = std::ranges::find(second.people, first.people[i]);
    if (other == second.people.end()) continue;
    const auto place = static_cast<std::size_t>(other - second.people.begin());
    differences.push_back(first.thresholds[i] - second.thresholds[place]);
  }
  return differences;
}

std::vector<StandardReport> standard_reports(const ThresholdReport& report) {
  std::vector<StandardReport> all;
  for (const study::threshold::Standard& of : study::threshold::standards_of(report.design)) {
    StandardReport& added = all.emplace_back(standard_report(report, all.size()));
    added.of = of;
    added.levels = study::threshold::levels_of(report.options(), of);
    added.words = study::threshold::words_of(report.design, of);
  }
  return all;
}

std::vector<DifferenceReport> difference_reports(std::span<const StandardReport> standards) {
  std::vector<DifferenceReport> all;
  std::vector<double> p;
  for (std::size_t i = 0; i < standards.size(); ++i) {
    for (std::size_t j = i + 1; j < standards.size(); ++j) {
      const std::vector<double> differences = paired_differences(standards[i], standards[j]);
      all.push_back({i, j, choices::group_test(differences), {}});
      if (all.back().difference.p) p.push_back(*all.back().difference.p);
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (DifferenceReport& one : all) {
    if (one.difference.p) one.p_holm = *next++;
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

constexpr int kSaidDifferent = 1;  ///< index into the choices of "same or different"

/// Answers "different" at the levels of one standard.
struct LevelAnswers {
  std::vector<Proportion> different;  ///< trials with two that differ, by level
  std::vector<Proportion> same;       ///< trials with two alike
};

void add_answer(LevelAnswers& answers, const TrialOutcome& trial) {
  const auto level = static_cast<std::size_t>(trial.chosen->level);
  if (level >= answers.same.size()) return;
  Proportion& of = *trial.right == kSaidDifferent ? answers.different[level] : answers.same[level];
  of.add(*trial.response == kSaidDifferent);
}

/// The answers of each standard.
using StandardAnswers = std::vector<LevelAnswers>;

StandardAnswers answers_by_standard(const Person& person, std::size_t standards,
                                    const study::threshold::ThresholdOptions& options) {
  const std::size_t levels = options.track.levels.size();
  const auto each = static_cast<std::size_t>(std::max(options.tracks_each, 1));
  StandardAnswers all(standards,
                      {std::vector<Proportion>(levels), std::vector<Proportion>(levels)});
  for (const TrialOutcome* trial : person.trials) {
    if (!in_track(*trial)) continue;
    const std::size_t standard = static_cast<std::size_t>(trial->chosen->track - 1) / each;
    if (standard < standards) add_answer(all[standard], *trial);
  }
  return all;
}

/// A share of which neither none nor all are: half an answer stands for none, and is taken from
/// all.
std::optional<double> inner_share(const Proportion& of) {
  if (of.n == 0) return std::nullopt;
  const double correct = std::clamp(static_cast<double>(of.correct), 0.5, of.n - 0.5);
  return correct / of.n;
}

/// Fewer hits than false alarms are most likely with d' = 0.
double d_of(const std::optional<SameDifferentFit>& fit) {
  return fit ? fit->d_prime : 0.0;
}

void add_d_prime(SameDifferentLevel& level) {
  const std::optional<double> hits = inner_share(level.different);
  const std::optional<double> false_alarms = inner_share(level.same_at_all);
  if (!hits || !false_alarms) return;
  level.d_differencing = d_of(differencing_d_prime({*hits, *false_alarms}));
  level.d_independent = d_of(independent_d_prime({*hits, *false_alarms}));
  const double low = std::min(*hits, *false_alarms);
  const double high = std::max(*hits, *false_alarms);
  const double sign = *hits < *false_alarms ? -1.0 : 1.0;
  level.signed_differencing = sign * d_of(differencing_d_prime({high, low}));
  level.signed_independent = sign * d_of(independent_d_prime({high, low}));
}

void add_levels(std::vector<SameDifferentLevel>& all, const std::string& participant,
                const StandardAnswers& answers, const std::vector<double>& levels) {
  for (std::size_t standard = 0; standard < answers.size(); ++standard) {
    const LevelAnswers& own = answers[standard];
    Proportion same_at_all;
    for (const Proportion& same : own.same) same_at_all += same;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (own.different[i].n + own.same[i].n == 0) continue;
      SameDifferentLevel& level = all.emplace_back(SameDifferentLevel{
          participant, standard, levels[i], own.different[i], own.same[i], same_at_all});
      add_d_prime(level);
    }
  }
}

void add_to(StandardAnswers& sum, const StandardAnswers& own) {
  for (std::size_t standard = 0; standard < own.size(); ++standard) {
    for (std::size_t i = 0; i < own[standard].same.size(); ++i) {
      sum[standard].different[i] += own[standard].different[i];
      sum[standard].same[i] += own[standard].same[i];
    }
  }
}

/// Counts and d', by participant, then pooled.
std::vector<SameDifferentLevel> same_different_levels(const study::Study& study,
                                                      std::span<const Person> people) {
  const study::threshold::ThresholdOptions& options = study::threshold::options_of(study);
  std::vector<SameDifferentLevel> all;
  if (options.question != study::threshold::Question::same_different) return all;
  const std::size_t standards = study::threshold::standards_of(study).size();
  StandardAnswers pooled = answers_by_standard({}, standards, options);
  for (const Person& person : people) {
    const StandardAnswers own = answers_by_standard(person, standards, options);
    add_levels(all, person.name, own, options.track.levels);
    add_to(pooled, own);
  }
  add_levels(all, "", pooled, options.track.levels);
  return all;
}

std::vector<SameDifferentGroup> same_different_groups(std::span<const SameDifferentLevel> levels) {
  struct Values {
    std::vector<double> differencing;
    std::vector<double> independent;
  };
  std::map<std::pair<std::size_t, double>, Values> values;
  for (const SameDifferentLevel& one : levels) {
    if (one.participant.empty() || !one.signed_differencing || !one.signed_independent) continue;
    Values& of = values[{one.standard, one.level}];
    of.differencing.push_back(*one.signed_differencing);
    of.independent.push_back(*one.signed_independent);
  }
  std::vector<SameDifferentGroup> groups;
  for (const auto& [place, of] : values) {
    groups.push_back({place.first, place.second, choices::unbounded_mean(of.differencing),
                      choices::unbounded_mean(of.independent)});
  }
  return groups;
}

}  // namespace

bool in_track(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::scored && trial.chosen && trial.chosen->track > 0;
}

bool in_control(const TrialOutcome& trial) noexcept {
  return trial.role == study::Role::control;
}

std::vector<Person> people_of(const Outcomes& outcomes) {
  std::vector<Person> people = choices::people_with(outcomes, [](const TrialOutcome& trial) {
    return trial.chosen && trial.response && trial.right &&
           trial.row.state == record::TrialState::answered;
  });
  for (Person& person : people) choices::sort_as_felt(person.trials);
  return people;
}

ThresholdReport make_report(const Outcomes& outcomes, int jobs) {
  ThresholdReport report = begun_report(outcomes);
  const std::vector<Person> people = people_of(outcomes);
  report.tracks = track_reports(report.design, people, report.by_posterior, jobs);
  report.standards = standard_reports(report);
  report.differences = difference_reports(report.standards);
  report.control = choices::against_guessing(people, report.guess, in_control);
  report.catches = choices::against_guessing(people, report.guess, [](const TrialOutcome& trial) {
    return trial.role == study::Role::catch_trial;
  });
  report.choice_use = choices::choice_use_of(people, report.choices, in_track);
  report.after_right = choices::repetition_of(people, true, in_track);
  report.after_wrong = choices::repetition_of(people, false, in_track);
  report.learning_db = group_learning(report);
  report.same_different = same_different_levels(report.design, people);
  report.same_different_groups = same_different_groups(report.same_different);
  report.warnings = threshold_warnings(report);
  return report;
}

procedures::Threshold mean_threshold(const MeanEstimate& mean) {
  procedures::Threshold threshold;
  threshold.level = mean.mean;
  if (const std::optional<Interval> interval = mean.known_interval()) {
    threshold.low = interval->low;
    threshold.high = interval->high;
  }
  return threshold;
}

}  // namespace touchtrial::analysis::threshold

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/same_different_d_prime.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace touchtrial::analysis::threshold {
namespace {

using choices::Person;

constexpr int kAnsweredDifferent = 1;  ///< index into the choices of "same or different"

/// Answers "different" at the levels of one standard.
struct LevelAnswers {
  std::vector<Proportion> different;  ///< trials with different planes, by level
  std::vector<Proportion> same;       ///< trials with equal planes, by level
};

void add_answer(LevelAnswers& answers, const TrialOutcome& trial) {
  const auto level = static_cast<std::size_t>(trial.chosen->level);
  if (level >= answers.same.size()) return;
  Proportion& counts =
      *trial.right == kAnsweredDifferent ? answers.different[level] : answers.same[level];
  counts.add(*trial.response == kAnsweredDifferent);
}

using StandardAnswers = std::vector<LevelAnswers>;  ///< by standard

StandardAnswers answers_by_standard(const Person& person, std::size_t standards,
                                    const study::threshold::ThresholdOptions& options) {
  const std::size_t levels = options.track.levels.size();
  const auto tracks_each = static_cast<std::size_t>(std::max(options.tracks_each, 1));
  StandardAnswers all(standards,
                      {std::vector<Proportion>(levels), std::vector<Proportion>(levels)});
  for (const TrialOutcome* trial : person.trials) {
    if (!is_track_trial(*trial)) continue;
    const std::size_t standard = static_cast<std::size_t>(trial->chosen->track - 1) / tracks_each;
    if (standard < standards) add_answer(all[standard], *trial);
  }
  return all;
}

/// A share in (0, 1): 0 answers are replaced by half an answer, n by n - 1/2.
std::optional<double> inner_share(const Proportion& trials) {
  if (trials.n == 0) return std::nullopt;
  const double correct = std::clamp(static_cast<double>(trials.correct), 0.5, trials.n - 0.5);
  return correct / trials.n;
}

/// The d' of a fit. With fewer hits than false alarms there is no fit, and 0 is most likely.
double d_prime_of(const std::optional<SameDifferentFit>& fit) {
  return fit ? fit->d_prime : 0.0;
}

void add_d_prime(SameDifferentLevel& level) {
  const std::optional<double> hits = inner_share(level.different);
  const std::optional<double> false_alarms = inner_share(level.same_at_all_levels);
  if (!hits || !false_alarms) return;
  level.d_differencing = d_prime_of(differencing_d_prime({*hits, *false_alarms}));
  level.d_independent = d_prime_of(independent_d_prime({*hits, *false_alarms}));
}

void add_levels(std::vector<SameDifferentLevel>& all, const std::string& participant,
                const StandardAnswers& answers, const std::vector<double>& levels) {
  for (std::size_t standard = 0; standard < answers.size(); ++standard) {
    const LevelAnswers& level_answers = answers[standard];
    Proportion same_at_all_levels;
    for (const Proportion& same : level_answers.same) same_at_all_levels += same;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (level_answers.different[i].n + level_answers.same[i].n == 0) continue;
      SameDifferentLevel& level = all.emplace_back(
          SameDifferentLevel{participant, standard, levels[i], level_answers.different[i],
                             level_answers.same[i], same_at_all_levels});
      add_d_prime(level);
    }
  }
}

void add_counts(StandardAnswers& sum, const StandardAnswers& added) {
  for (std::size_t standard = 0; standard < added.size(); ++standard) {
    for (std::size_t i = 0; i < added[standard].same.size(); ++i) {
      sum[standard].different[i] += added[standard].different[i];
      sum[standard].same[i] += added[standard].same[i];
    }
  }
}

/// Bootstrap draws per interval; each needs a search for d'.
constexpr int kDraws = 1999;

using DPrimeModel = std::optional<SameDifferentFit> (*)(const SameDifferent& shares);

/// d' of these people's pooled answers; a person drawn twice counts twice.
double pooled_d_prime(std::span<const SameDifferentLevel* const> people,
                      std::span<const std::size_t> person_draws, DPrimeModel d_prime) {
  Proportion hits;
  Proportion false_alarms;
  for (const std::size_t i : person_draws) {
    hits += people[i]->different;
    false_alarms += people[i]->same_at_all_levels;
  }
  return d_prime_of(d_prime({*inner_share(hits), *inner_share(false_alarms)}));
}

/// The interval of the pooled d'; nothing if its width is 0.
std::optional<Interval> interval_of(std::span<const SameDifferentLevel* const> people,
                                    DPrimeModel d_prime) {
  if (people.size() < kMinBootstrapParticipants) return std::nullopt;
  const auto interval = bootstrap_statistic(
      people.size(),
      [&](std::span<const std::size_t> person_draws) {
        return pooled_d_prime(people, person_draws, d_prime);
      },
      0, kDraws);
  return interval && interval->low < interval->high ? interval : std::nullopt;
}

}  // namespace

std::vector<SameDifferentLevel> same_different_levels(const study::Study& study,
                                                      std::span<const Person> people) {
  const study::threshold::ThresholdOptions& options = study::threshold::options_of(study);
  std::vector<SameDifferentLevel> all;
  if (options.question != study::threshold::Question::same_different) return all;
  const std::size_t standards = study::threshold::standards_of(study).size();
  StandardAnswers pooled = answers_by_standard({}, standards, options);
  for (const Person& person : people) {
    const StandardAnswers answers = answers_by_standard(person, standards, options);
    add_levels(all, person.name, answers, options.track.levels);
    add_counts(pooled, answers);
  }
  add_levels(all, "", pooled, options.track.levels);
  return all;
}

std::vector<SameDifferentGroup> same_different_groups(std::span<const SameDifferentLevel> levels) {
  std::map<std::pair<std::size_t, double>, std::vector<const SameDifferentLevel*>> people;
  for (const SameDifferentLevel& level : levels) {
    if (!level.participant.empty() && level.d_differencing) {
      people[{level.standard, level.level}].push_back(&level);
    }
  }
  std::vector<SameDifferentGroup> groups;
  for (const SameDifferentLevel& level : levels) {
    if (!level.participant.empty() || !level.d_differencing) continue;
    const auto& answers = people[{level.standard, level.level}];
    groups.push_back({level.standard,
                      level.level,
                      static_cast<int>(answers.size()),
                      {level.d_differencing, interval_of(answers, differencing_d_prime)},
                      {level.d_independent, interval_of(answers, independent_d_prime)}});
  }
  return groups;
}

}  // namespace touchtrial::analysis::threshold

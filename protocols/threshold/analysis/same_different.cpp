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
  std::vector<Proportion> different;  ///< trials with two that differ, by level
  std::vector<Proportion> same;       ///< trials with two alike
};

void add_answer(LevelAnswers& answers, const TrialOutcome& trial) {
  const auto level = static_cast<std::size_t>(trial.chosen->level);
  if (level >= answers.same.size()) return;
  Proportion& of =
      *trial.right == kAnsweredDifferent ? answers.different[level] : answers.same[level];
  of.add(*trial.response == kAnsweredDifferent);
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

/// A share in (0, 1): 0 answers are replaced by half an answer, n by n - 1/2.
std::optional<double> inner_share(const Proportion& of) {
  if (of.n == 0) return std::nullopt;
  const double correct = std::clamp(static_cast<double>(of.correct), 0.5, of.n - 0.5);
  return correct / of.n;
}

/// With fewer hits than false alarms, d' = 0 is most likely.
double d_of(const std::optional<SameDifferentFit>& fit) {
  return fit ? fit->d_prime : 0.0;
}

void add_d_prime(SameDifferentLevel& level) {
  const std::optional<double> hits = inner_share(level.different);
  const std::optional<double> false_alarms = inner_share(level.same_at_all);
  if (!hits || !false_alarms) return;
  level.d_differencing = d_of(differencing_d_prime({*hits, *false_alarms}));
  level.d_independent = d_of(independent_d_prime({*hits, *false_alarms}));
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

/// The number of draws of people for one interval; each needs a search for d'.
constexpr int kDraws = 1999;

using DPrime = std::optional<SameDifferentFit> (*)(const SameDifferent& shares);

/// d' of these people's pooled answers; a person drawn twice counts twice.
double pooled_d_prime(std::span<const SameDifferentLevel* const> people,
                      std::span<const std::size_t> drawn, DPrime d_prime) {
  Proportion hits;
  Proportion false_alarms;
  for (const std::size_t i : drawn) {
    hits += people[i]->different;
    false_alarms += people[i]->same_at_all;
  }
  return d_of(d_prime({*inner_share(hits), *inner_share(false_alarms)}));
}

/// The interval of d' of all answers pooled; nothing if it would have no width.
std::optional<Interval> interval_of(std::span<const SameDifferentLevel* const> people,
                                    DPrime d_prime) {
  if (people.size() < kMinForBootstrap) return std::nullopt;
  const auto interval = bootstrap_statistic(
      people.size(),
      [&](std::span<const std::size_t> drawn) { return pooled_d_prime(people, drawn, d_prime); }, 0,
      kDraws);
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
    const StandardAnswers own = answers_by_standard(person, standards, options);
    add_levels(all, person.name, own, options.track.levels);
    add_to(pooled, own);
  }
  add_levels(all, "", pooled, options.track.levels);
  return all;
}

std::vector<SameDifferentGroup> same_different_groups(std::span<const SameDifferentLevel> levels) {
  std::map<std::pair<std::size_t, double>, std::vector<const SameDifferentLevel*>> people;
  for (const SameDifferentLevel& one : levels) {
    if (!one.participant.empty() && one.d_differencing) {
      people[{one.standard, one.level}].push_back(&one);
    }
  }
  std::vector<SameDifferentGroup> groups;
  for (const SameDifferentLevel& one : levels) {
    if (!one.participant.empty() || !one.d_differencing) continue;
    const auto& own = people[{one.standard, one.level}];
    groups.push_back({one.standard,
                      one.level,
                      static_cast<int>(own.size()),
                      {one.d_differencing, interval_of(own, differencing_d_prime)},
                      {one.d_independent, interval_of(own, independent_d_prime)}});
  }
  return groups;
}

}  // namespace touchtrial::analysis::threshold

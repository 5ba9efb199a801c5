#include "protocols/threshold/planning/threshold_plan.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace touchtrial::planning::threshold {
namespace {

using analysis::Bounds;

constexpr double kNoInterval = std::numeric_limits<double>::infinity();

/// One sample: half-widths, and whether the comparison was significant.
struct SampleResult {
  std::vector<double> half_widths;  ///< by standard
  double of_difference = kNoInterval;
  bool significant = false;
  std::optional<bool> false_alarm;  ///< empty if the pool has no mean difference
};

double half_width_of(std::span<const Bounds> people) {
  const auto interval = analysis::censored_mean(people).interval;
  return interval ? 0.5 * (interval->high - interval->low) : kNoInterval;
}

bool rejects(std::span<const Bounds> people, double null, double alpha) {
  const auto p = analysis::censored_p(people, null, analysis::Sides::two);
  return p && *p <= alpha;
}

/// Draws people of a pool with replacement, by index.
std::vector<std::size_t> draw_sample(std::size_t people, int size, RandomStream& random) {
  std::vector<std::size_t> sample(static_cast<std::size_t>(size));
  for (std::size_t& one : sample) one = static_cast<std::size_t>(random.below(people));
  return sample;
}

std::vector<Bounds> sampled(std::span<const Bounds> pool, std::span<const std::size_t> sample) {
  std::vector<Bounds> people;
  for (const std::size_t person : sample) people.push_back(pool[person]);
  return people;
}

/// Differences between the two thresholds that the plan compares.
struct Differences {
  std::vector<Bounds> people;
  std::optional<double> mean;  ///< over the whole pool
};

Differences differences_of(const ThresholdPool& pool, const ThresholdPlan& plan) {
  if (!plan.difference) return {};
  std::vector<Bounds> people = differences_in(pool, *plan.difference);
  const std::optional<double> mean = analysis::censored_mean(people).mean;
  return {std::move(people), mean};
}

void compare(const Differences& differences, const ThresholdPlan& plan,
             std::span<const std::size_t> sample, SampleResult& result) {
  const std::vector<Bounds> people = sampled(differences.people, sample);
  result.of_difference = half_width_of(people);
  result.significant = rejects(people, 0.0, plan.alpha);
  if (differences.mean) result.false_alarm = rejects(people, *differences.mean, plan.alpha);
}

std::optional<double> finite_quantile(std::span<const double> sorted, double share) {
  const auto found = analysis::quantile(sorted, share);
  return found && std::isfinite(*found) ? found : std::nullopt;
}

HalfWidths figures_of(std::vector<double> half_widths, const std::optional<double>& wanted) {
  std::ranges::sort(half_widths);
  HalfWidths figures;
  figures.median = finite_quantile(half_widths, 0.5);
  figures.upper = finite_quantile(half_widths, 0.9);
  figures.without.n = static_cast<int>(half_widths.size());
  figures.without.correct = static_cast<int>(std::ranges::count(half_widths, kNoInterval));
  if (!wanted) return figures;
  figures.narrow.n = static_cast<int>(half_widths.size());
  figures.narrow.correct =
      static_cast<int>(std::ranges::upper_bound(half_widths, *wanted) - half_widths.begin());
  figures.narrow_interval = analysis::wilson_interval(figures.narrow);
  return figures;
}

DifferencePower power_of(const std::vector<SampleResult>& samples, const ThresholdPlan& plan) {
  DifferencePower power;
  std::vector<double> widths;
  for (const SampleResult& sample : samples) {
    widths.push_back(sample.of_difference);
    ++power.significant.n;
    power.significant.correct += sample.significant ? 1 : 0;
    if (sample.false_alarm) power.false_alarms.add(*sample.false_alarm);
  }
  power.width = figures_of(std::move(widths), plan.width_db);
  power.power = analysis::wilson_interval(power.significant);
  power.type_one = analysis::wilson_interval(power.false_alarms);
  return power;
}

ThresholdRow threshold_row(const ThresholdPool& pool, const ThresholdPlan& plan, int size,
                           const std::vector<SampleResult>& samples) {
  ThresholdRow row{.trials = pool.trials, .participants = size, .standards = {}, .difference = {}};
  for (std::size_t standard = 0; standard < pool.standards.size(); ++standard) {
    std::vector<double> widths;
    for (const SampleResult& sample : samples) widths.push_back(sample.half_widths[standard]);
    row.standards.push_back(figures_of(std::move(widths), plan.width_db));
  }
  if (plan.difference) row.difference = power_of(samples, plan);
  return row;
}

}  // namespace

std::vector<Bounds> differences_in(const ThresholdPool& pool,
                                   const std::pair<std::size_t, std::size_t>& of) {
  std::vector<Bounds> differences;
  for (const std::vector<Bounds>& person : pool.people) {
    differences.push_back(analysis::difference_of(person[of.first], person[of.second]));
  }
  return differences;
}

std::vector<Bounds> thresholds_in(const ThresholdPool& pool, std::size_t standard) {
  std::vector<Bounds> thresholds;
  for (const std::vector<Bounds>& person : pool.people) thresholds.push_back(person[standard]);
  return thresholds;
}

std::vector<ThresholdRow> rows_of(const ThresholdPool& pool, const ThresholdPlan& plan, int jobs) {
  std::vector<std::vector<Bounds>> standards;
  for (std::size_t i = 0; i < pool.standards.size(); ++i) {
    standards.push_back(thresholds_in(pool, i));
  }
  const Differences differences = differences_of(pool, plan);
  std::vector<ThresholdRow> rows;
  for (const int size : plan.participants) {
    std::vector<SampleResult> samples(static_cast<std::size_t>(plan.runs));
    in_parallel(jobs, samples.size(), [&](std::size_t run) {
      RandomStream random(plan.seed, "power: sample of " + std::to_string(size), run);
      const std::vector<std::size_t> sample = draw_sample(pool.people.size(), size, random);
      for (const std::vector<Bounds>& people : standards) {
        samples[run].half_widths.push_back(half_width_of(sampled(people, sample)));
      }
      if (plan.difference) compare(differences, plan, sample, samples[run]);
    });
    rows.push_back(threshold_row(pool, plan, size, samples));
  }
  return rows;
}

}  // namespace touchtrial::planning::threshold

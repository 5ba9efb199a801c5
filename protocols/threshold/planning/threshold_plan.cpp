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

struct SampleResult {
  std::vector<double> half_widths;  ///< by standard
  double difference_half_width = kNoInterval;
  bool significant = false;
  std::optional<bool> false_alarm;  ///< empty if the pool has no mean difference
};

double half_width_of(std::span<const Bounds> people) {
  const auto interval = analysis::censored_mean(people).interval;
  return interval ? 0.5 * (interval->high - interval->low) : kNoInterval;
}

bool is_rejected(std::span<const Bounds> people, double null, double alpha) {
  const auto p = analysis::censored_p(people, null, analysis::Sides::two);
  return p && *p <= alpha;
}

/// Draws people of a pool with replacement, by index.
std::vector<std::size_t> draw_sample(std::size_t people, int size, RandomStream& random) {
  std::vector<std::size_t> sample(static_cast<std::size_t>(size));
  for (std::size_t& one : sample) one = static_cast<std::size_t>(random.below(people));
  return sample;
}

std::vector<Bounds> select_people(std::span<const Bounds> pool,
                                  std::span<const std::size_t> sample) {
  std::vector<Bounds> people;
  for (const std::size_t person : sample) people.push_back(pool[person]);
  return people;
}

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

void add_difference(const Differences& differences, const ThresholdPlan& plan,
                    std::span<const std::size_t> sample, SampleResult& result) {
  const std::vector<Bounds> people = select_people(differences.people, sample);
  result.difference_half_width = half_width_of(people);
  result.significant = is_rejected(people, 0.0, plan.alpha);
  if (differences.mean) result.false_alarm = is_rejected(people, *differences.mean, plan.alpha);
}

std::optional<double> finite_quantile(std::span<const double> sorted, double share) {
  const auto quantile = analysis::quantile(sorted, share);
  return quantile && std::isfinite(*quantile) ? quantile : std::nullopt;
}

HalfWidths summarise_half_widths(std::vector<double> half_widths,
                                 const std::optional<double>& target) {
  std::ranges::sort(half_widths);
  HalfWidths figures;
  figures.median = finite_quantile(half_widths, 0.5);
  figures.upper = finite_quantile(half_widths, 0.9);
  figures.without_interval.n = static_cast<int>(half_widths.size());
  figures.without_interval.correct = static_cast<int>(std::ranges::count(half_widths, kNoInterval));
  if (!target) return figures;
  figures.narrow.n = static_cast<int>(half_widths.size());
  figures.narrow.correct =
      static_cast<int>(std::ranges::upper_bound(half_widths, *target) - half_widths.begin());
  figures.narrow_interval = analysis::wilson_interval(figures.narrow);
  return figures;
}

DifferencePower power_of(const std::vector<SampleResult>& samples, const ThresholdPlan& plan) {
  DifferencePower power;
  std::vector<double> widths;
  for (const SampleResult& sample : samples) {
    widths.push_back(sample.difference_half_width);
    power.significant.add(sample.significant);
    if (sample.false_alarm) power.false_alarms.add(*sample.false_alarm);
  }
  power.width = summarise_half_widths(std::move(widths), plan.width_db);
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
    row.standards.push_back(summarise_half_widths(std::move(widths), plan.width_db));
  }
  if (plan.difference) row.difference = power_of(samples, plan);
  return row;
}

}  // namespace

std::vector<Bounds> differences_in(const ThresholdPool& pool,
                                   const std::pair<std::size_t, std::size_t>& standards) {
  std::vector<Bounds> differences;
  for (const std::vector<Bounds>& person : pool.people) {
    differences.push_back(
        analysis::difference_of(person[standards.first], person[standards.second]));
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
        samples[run].half_widths.push_back(half_width_of(select_people(people, sample)));
      }
      if (plan.difference) add_difference(differences, plan, sample, samples[run]);
    });
    rows.push_back(threshold_row(pool, plan, size, samples));
  }
  return rows;
}

}  // namespace touchtrial::planning::threshold

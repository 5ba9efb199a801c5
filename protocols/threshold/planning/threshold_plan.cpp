#include "protocols/threshold/planning/threshold_plan.hpp"

#include "analysis/statistics/mean_test.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace touchtrial::planning::threshold {
namespace {

constexpr double kAnyNumber = std::numeric_limits<double>::max();
constexpr double kNoInterval = std::numeric_limits<double>::infinity();

/// One sample: half-widths, and whether the comparison was significant.
struct SampleResult {
  std::vector<double> half_widths;  ///< by standard
  double of_difference = kNoInterval;
  bool significant = false;
  bool false_alarm = false;
};

double half_width_of(std::span<const double> values) {
  const analysis::MeanEstimate mean = analysis::participant_mean(values, {-kAnyNumber, kAnyNumber});
  const auto interval = mean.known_interval();
  return interval ? 0.5 * (interval->high - interval->low) : kNoInterval;
}

bool rejects(std::span<const double> values, double alpha) {
  const auto p = analysis::t_test_p(values, 0.0, analysis::Sides::two);
  return p && *p <= alpha;
}

/// People of a pool, by their indices.
std::vector<std::size_t> drawn(std::size_t people, int size, RandomStream& random) {
  std::vector<std::size_t> sample(static_cast<std::size_t>(size));
  for (std::size_t& one : sample) one = static_cast<std::size_t>(random.below(people));
  return sample;
}

std::vector<double> thresholds_of_sample(const ThresholdPool& pool,
                                         std::span<const std::size_t> sample,
                                         std::size_t standard) {
  std::vector<double> values;
  for (const std::size_t person : sample) {
    if (const auto& threshold = pool.people[person][standard]) values.push_back(*threshold);
  }
  return values;
}

std::optional<double> difference_of(const std::vector<std::optional<double>>& person,
                                    const std::pair<std::size_t, std::size_t>& of) {
  const std::optional<double>& first = person[of.first];
  const std::optional<double>& second = person[of.second];
  if (!first || !second) return std::nullopt;
  return *first - *second;
}

void compare(const ThresholdPool& pool, const ThresholdPlan& plan,
             std::span<const std::size_t> sample, double mean_difference, SampleResult& result) {
  std::vector<double> values;
  for (const std::size_t person : sample) {
    if (const auto value = difference_of(pool.people[person], *plan.difference)) {
      values.push_back(*value);
    }
  }
  result.of_difference = half_width_of(values);
  result.significant = rejects(values, plan.alpha);
  for (double& value : values) value -= mean_difference;
  result.false_alarm = rejects(values, plan.alpha);
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
  figures.without = static_cast<int>(std::ranges::count(half_widths, kNoInterval));
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
    ++power.false_alarms.n;
    power.significant.correct += sample.significant ? 1 : 0;
    power.false_alarms.correct += sample.false_alarm ? 1 : 0;
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

std::vector<double> differences_in(const ThresholdPool& pool,
                                   const std::pair<std::size_t, std::size_t>& of) {
  std::vector<double> values;
  for (const auto& person : pool.people) {
    if (const auto value = difference_of(person, of)) values.push_back(*value);
  }
  return values;
}

std::vector<double> thresholds_in(const ThresholdPool& pool, std::size_t standard) {
  std::vector<double> values;
  for (const auto& person : pool.people) {
    if (person[standard]) values.push_back(*person[standard]);
  }
  return values;
}

std::vector<ThresholdRow> rows_of(const ThresholdPool& pool, const ThresholdPlan& plan, int jobs) {
  double mean_difference = 0.0;
  if (plan.difference) {
    const std::vector<double> all = differences_in(pool, *plan.difference);
    if (!all.empty()) mean_difference = analysis::mean_of(all);
  }
  std::vector<ThresholdRow> rows;
  for (const int size : plan.participants) {
    std::vector<SampleResult> samples(static_cast<std::size_t>(plan.runs));
    in_parallel(jobs, samples.size(), [&](std::size_t run) {
      RandomStream random(plan.seed, "power: sample of " + std::to_string(size), run);
      const std::vector<std::size_t> sample = drawn(pool.people.size(), size, random);
      for (std::size_t standard = 0; standard < pool.standards.size(); ++standard) {
        samples[run].half_widths.push_back(
            half_width_of(thresholds_of_sample(pool, sample, standard)));
      }
      if (plan.difference) compare(pool, plan, sample, mean_difference, samples[run]);
    });
    rows.push_back(threshold_row(pool, plan, size, samples));
  }
  return rows;
}

}  // namespace touchtrial::planning::threshold

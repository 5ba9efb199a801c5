/// \file The width of the interval of a mean threshold, and the power of a difference between two
/// thresholds, by number of participants. Source: docs/planning.md, "Power of threshold studies".
#pragma once

#include "analysis/planning/power_curve.hpp"
#include "analysis/statistics/censored_mean.hpp"
#include "analysis/statistics/proportion.hpp"
#include "protocols/threshold/planning/threshold_pool.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::planning::threshold {

struct ThresholdPlan {
  std::vector<int> participants;     ///< sample sizes, each >= 2
  int runs = 1000;                   ///< samples per size, >= 1
  std::uint64_t seed = 1;            ///< for drawing samples
  std::optional<double> width_db{};  ///< target half-width
  /// Indices of the standards whose thresholds are compared, first minus second.
  std::optional<std::pair<std::size_t, std::size_t>> difference{};
  double alpha = 0.05;  ///< two-sided level of the comparison
};

/// Half-widths of the 95 % interval of a mean, over samples.
struct HalfWidths {
  std::optional<double> median;  ///< empty if half of the samples have no interval
  std::optional<double> upper;   ///< 90 % quantile; empty if it is not finite
  /// Samples without an interval, because most thresholds lie beyond the levels.
  analysis::Proportion without_interval;
  analysis::Proportion narrow;  ///< samples within the target half-width; n = 0 without a target
  analysis::Interval narrow_interval{};  ///< Wilson's, 95 %
};

struct DifferencePower {
  HalfWidths width;
  analysis::Proportion significant;  ///< analysis::censored_p of the differences
  analysis::Interval power{};        ///< Wilson's, 95 %
  /// Significant results for the same samples minus the pool's mean difference; n = 0 if the pool
  /// has no mean.
  analysis::Proportion false_alarms;
  analysis::Interval type_one{};
};

struct ThresholdRow {
  int trials = 0;
  int participants = 0;
  std::vector<HalfWidths> standards;
  std::optional<DifferencePower> difference;
};

/// Each participant's difference of two thresholds, first minus second.
[[nodiscard]] std::vector<analysis::Bounds> differences_in(
    const ThresholdPool& pool, const std::pair<std::size_t, std::size_t>& standards);
/// Each participant's threshold of one standard.
[[nodiscard]] std::vector<analysis::Bounds> thresholds_in(const ThresholdPool& pool,
                                                          std::size_t standard);

/// Computes one row per size. A sample draws participants from the pool with replacement.
/// \pre the pool has at least one participant and the standards of the plan
/// \param jobs  number of threads; does not affect results
[[nodiscard]] std::vector<ThresholdRow> rows_of(const ThresholdPool& pool,
                                                const ThresholdPlan& plan, int jobs);

/// The setting of a power analysis, for reports.
struct ThresholdPlanSetting {
  std::string study;
  std::string subject;   ///< words_of the subject model
  std::string unit;      ///< of levels
  std::string device{};  ///< analysis::device_words of the subject's device
};

/// A pool and its rows for each number of trials.
struct ThresholdPlanReport {
  ThresholdPlanSetting setting;
  ThresholdPlan plan;
  std::vector<std::pair<ThresholdPool, std::vector<ThresholdRow>>> pools;
};

/// The curve of studies with a significant difference. Without a difference, it counts studies
/// whose interval of the first threshold is within the target half-width; without both, it has no
/// series.
[[nodiscard]] PowerCurve threshold_power_curve(const ThresholdPlanReport& report);
[[nodiscard]] std::string threshold_plan_text(const ThresholdPlanReport& report);
[[nodiscard]] std::string threshold_plan_json(const ThresholdPlanReport& report);

}  // namespace touchtrial::planning::threshold

/// \file The report of a power analysis by simulation: power given the assumed sensitivity. Source:
/// docs/planning.md.
#pragma once

#include "analysis/planning/power_curve.hpp"
#include "analysis/statistics/proportion.hpp"
#include "protocols/identification/planning/power_runs.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning::identification {

/// Widths of the 95 % t interval, over the runs of one size.
struct WidthFigures {
  double mean = 0.0;
  double standard_error = 0.0;  ///< Monte Carlo, of the mean
  double lower = 0.0;           ///< 10 % quantile
  double median = 0.0;
  double upper = 0.0;  ///< 90 % quantile
};

/// The results for one number of participants.
struct PowerRow {
  int participants = 0;
  analysis::Proportion significant;  ///< significant runs under Hypothesis::population
  analysis::Interval power{};        ///< Wilson, 95 %
  double estimate = 0.0;             ///< mean over runs
  double estimate_sd = 0.0;          ///< between runs
  WidthFigures width;
  analysis::Proportion false_alarms;  ///< significant runs under Hypothesis::null
  analysis::Interval type_one{};      ///< Wilson, 95 %
  double attainable = 0.0;            ///< mean of PowerRun::attainable
  bool has_fixed_counts = true;       ///< as in PowerSetting
  double level = 0.05;                ///< as in PowerPlan

  [[nodiscard]] double estimated_power() const { return significant.share().value_or(0.0); }
  [[nodiscard]] double estimated_error() const { return false_alarms.share().value_or(0.0); }
};

/// The type-I error in relation to the test's level.
enum class ErrorVerdict {
  holds,         ///< the interval overlaps the range from the attainable error to the level
  conservative,  ///< the interval lies below the attainable error
  excessive,     ///< the interval lies above the level
  conditional,   ///< the error depends on the orders drawn by this study's seed
};
[[nodiscard]] ErrorVerdict verdict_of(const PowerRow& row) noexcept;
[[nodiscard]] std::string_view name_of(ErrorVerdict verdict);

/// The sizes that reach a power.
struct TargetSize {
  double target = 0.0;
  std::optional<int> smallest;  ///< the estimates of this and all larger sizes reach the target
  std::optional<int>
      smallest_certain;  ///< the intervals of this and all larger sizes lie above the target
};

struct PowerReport {
  PowerSetting setting;
  PowerPlan plan;
  std::vector<PowerRow> rows;  ///< by size
  std::vector<TargetSize> targets;
  std::vector<std::string> warnings;  ///< one line each
};

[[nodiscard]] PowerReport make_power_report(const PowerRuns& power);

/// The stamp of all output, with the condition under which the power holds.
[[nodiscard]] std::string power_stamp(const PowerSetting& setting);

[[nodiscard]] PowerCurve power_curve(const PowerReport& report);

/// Tables for a terminal, ending with a line feed.
[[nodiscard]] std::string power_text(const PowerReport& report);
[[nodiscard]] std::string power_json(const PowerReport& report);

}  // namespace touchtrial::planning::identification

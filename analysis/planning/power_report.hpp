/// \file What a power run found. Everything in it is of simulated participants: power given the
/// assumed sensitivity. Source: docs/power.md.
#pragma once

#include "analysis/figures/figure.hpp"
#include "analysis/planning/power_progress.hpp"
#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// Over the runs of one size.
struct WidthFigures {
  double mean = 0.0;
  double standard_error = 0.0;  ///< Monte Carlo, of the mean
  double lower = 0.0;           ///< a tenth of the runs is narrower
  double median = 0.0;
  double upper = 0.0;  ///< a tenth is wider
};

/// One size.
struct PowerRow {
  int participants = 0;
  analysis::Proportion significant;  ///< of the runs with the population
  analysis::Interval power{};        ///< power_interval
  bool stopped_early = false;
  double estimate = 0.0;              ///< mean over runs
  double estimate_sd = 0.0;           ///< from run to run
  WidthFigures width;                 ///< of the 95 % t interval
  analysis::Proportion false_alarms;  ///< of the runs under the null
  analysis::Interval type_one{};      ///< Wilson, 95 %
  double attainable = 0.0;       ///< what the test's error is exactly, as data are whole numbers
  bool has_fixed_counts = true;  ///< PowerSetting
};

/// The type-I error against its level.
enum class ErrorVerdict {
  holds,         ///< the interval reaches from what is attainable to the level, or into it
  conservative,  ///< the interval lies below what is attainable
  excessive,     ///< the interval lies above the level
  conditional,   ///< none is given: the error is that of the orders of this study's seed
};
[[nodiscard]] ErrorVerdict verdict_of(const PowerRow& row) noexcept;
[[nodiscard]] std::string_view name_of(ErrorVerdict verdict);

/// Which sizes reach a power.
struct TargetSize {
  double target = 0.0;
  std::optional<int> smallest;  ///< it and all larger ones reach it, going by the estimates
  std::optional<int> surely;    ///< it and all larger ones reach it with their whole intervals
};

struct PowerReport {
  PowerSetting setting;
  PowerPlan plan;
  std::vector<PowerRow> rows;  ///< by size
  std::vector<TargetSize> targets;
  std::vector<std::string> warnings;  ///< what a reader could take a figure for, wrongly
};

/// \param progress  a complete one of all shards
/// \throws std::invalid_argument if it is not
[[nodiscard]] PowerReport make_power_report(const PowerProgress& progress);

/// Tables for a terminal; ends with a line feed, and so do the others.
[[nodiscard]] std::string power_text(const PowerReport& report);
[[nodiscard]] std::string power_json(const PowerReport& report);
[[nodiscard]] std::string power_csv(const PowerReport& report);
[[nodiscard]] std::string power_markdown(const PowerReport& report);
/// Power, type-I error and interval width against the number of participants.
[[nodiscard]] analysis::Figure power_figure(const PowerReport& report);

}  // namespace touchtrial::planning

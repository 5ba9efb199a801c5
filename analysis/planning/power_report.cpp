#include "analysis/planning/power_report.hpp"

#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/named.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

struct Moments {
  double mean = 0.0;
  double sd = 0.0;
};

Moments moments_of(const std::vector<double>& values) {
  Moments moments;
  if (!values.empty()) moments.mean = analysis::mean_of(values);
  if (values.size() < 2) return moments;
  const auto freedom = static_cast<double>(values.size() - 1);
  moments.sd = analysis::standard_deviation(values, moments.mean, freedom);
  return moments;
}

analysis::Proportion significant_of(const PowerCell& cell, double level) {
  const auto significant = std::ranges::count_if(
      cell.runs, [level](const PowerRun& run) { return is_significant(run, level); });
  return {static_cast<int>(cell.runs.size()), static_cast<int>(significant)};
}

WidthFigures widths_of(const PowerCell& cell) {
  std::vector<double> widths;
  for (const PowerRun& run : cell.runs) widths.push_back(run.width());
  std::ranges::sort(widths);
  const Moments moments = moments_of(widths);
  return {moments.mean, moments.sd / std::sqrt(static_cast<double>(widths.size())),
          *analysis::quantile(widths, 0.1), *analysis::quantile(widths, 0.5),
          *analysis::quantile(widths, 0.9)};
}

PowerRow row_of(const PowerRuns& power, const PowerCell& population, const PowerCell& null) {
  const PowerPlan& plan = power.plan;
  PowerRow row;
  row.has_fixed_counts = power.setting.has_fixed_counts;
  row.level = plan.level;
  row.participants = population.participants;
  row.significant = significant_of(population, plan.level);
  row.power = analysis::wilson_interval(row.significant);
  std::vector<double> estimates;
  for (const PowerRun& run : population.runs) estimates.push_back(run.estimate);
  const Moments moments = moments_of(estimates);
  row.estimate = moments.mean;
  row.estimate_sd = moments.sd;
  row.width = widths_of(population);
  row.false_alarms = significant_of(null, plan.level);
  row.type_one = analysis::wilson_interval(row.false_alarms);
  std::vector<double> attainable;
  for (const PowerRun& run : null.runs) attainable.push_back(run.attainable);
  row.attainable = moments_of(attainable).mean;
  // A test whose error is the same in all runs keeps it to the last digit.
  if (!attainable.empty() && std::ranges::count(attainable, row.level) == std::ssize(attainable)) {
    row.attainable = row.level;
  }
  return row;
}

/// The smallest size of which, and of all larger ones, `holds` is true.
template <typename Holds>
std::optional<int> from_which_on(const std::vector<PowerRow>& rows, const Holds& holds) {
  std::optional<int> smallest;
  for (auto row = rows.rbegin(); row != rows.rend() && holds(*row); ++row) {
    smallest = row->participants;
  }
  return smallest;
}

TargetSize target_size(const std::vector<PowerRow>& rows, double target) {
  return {target,
          from_which_on(rows, [&](const PowerRow& row) { return row.estimated_power() >= target; }),
          from_which_on(rows, [&](const PowerRow& row) { return row.power.low >= target; })};
}

std::vector<std::string> warnings_of(const PowerReport& report) {
  std::vector<std::string> warnings;
  for (const PowerRow& row : report.rows) {
    if (verdict_of(row) == ErrorVerdict::excessive) {
      warnings.push_back(fmt::format(
          "With {} participants the type-I error lies above the level of the test: the test does "
          "not keep its level in this study.",
          row.participants));
    }
    if (row.attainable == 0.0) {
      warnings.push_back(fmt::format(
          "With {} participants the test could not be significant in any of the runs under the "
          "null.",
          row.participants));
    }
  }
  const auto all = [&](const auto& holds) { return std::ranges::all_of(report.rows, holds); };
  if (all([](const PowerRow& row) { return row.significant.correct == row.significant.n; })) {
    warnings.emplace_back(
        "Every simulated study was significant, with every size: for this test the smallest size "
        "is enough if people are as sensitive as assumed; choose the size by the interval's "
        "width.");
  }
  return warnings;
}

}  // namespace

ErrorVerdict verdict_of(const PowerRow& row) noexcept {
  if (!row.has_fixed_counts) return ErrorVerdict::conditional;
  if (row.type_one.low > row.level) return ErrorVerdict::excessive;
  if (row.type_one.high < row.attainable) return ErrorVerdict::conservative;
  return ErrorVerdict::holds;
}

std::string_view name_of(ErrorVerdict verdict) {
  using enum ErrorVerdict;
  static constexpr auto kNames =
      std::to_array<Named<ErrorVerdict>>({{"conservative", conservative},
                                          {"excessive", excessive},
                                          {"these orders alone", conditional},
                                          {"holds", holds}});
  return name_in(kNames, verdict);
}

PowerReport make_power_report(const PowerRuns& power) {
  PowerReport report{power.setting, power.plan, {}, {}, {}};
  for (std::size_t i = 0; i + 1 < power.cells.size(); i += 2) {
    report.rows.push_back(row_of(power, power.cells[i], power.cells[i + 1]));
  }
  for (const double target : kPowerTargets) {
    report.targets.push_back(target_size(report.rows, target));
  }
  report.warnings = warnings_of(report);
  return report;
}

}  // namespace touchtrial::planning

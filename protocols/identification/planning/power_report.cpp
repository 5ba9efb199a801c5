#include "protocols/identification/planning/power_report.hpp"

#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/named.hpp"
#include "core/strict_json.hpp"
#include "protocols/identification/planning/primary_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning::identification {
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

analysis::Proportion count_significant(const PowerCell& cell, double level) {
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
  row.significant = count_significant(population, plan.level);
  row.power = analysis::wilson_interval(row.significant);
  std::vector<double> estimates;
  for (const PowerRun& run : population.runs) estimates.push_back(run.estimate);
  const Moments moments = moments_of(estimates);
  row.estimate = moments.mean;
  row.estimate_sd = moments.sd;
  row.width = widths_of(population);
  row.false_alarms = count_significant(null, plan.level);
  row.type_one = analysis::wilson_interval(row.false_alarms);
  std::vector<double> attainable;
  for (const PowerRun& run : null.runs) attainable.push_back(run.attainable);
  row.attainable = moments_of(attainable).mean;
  // If the attainable error equals the level in all runs, the mean must equal it exactly.
  if (!attainable.empty() && std::ranges::count(attainable, row.level) == std::ssize(attainable)) {
    row.attainable = row.level;
  }
  return row;
}

/// The smallest size such that it and all larger sizes meet the condition.
template <typename Condition>
std::optional<int> smallest_size(const std::vector<PowerRow>& rows, const Condition& condition) {
  std::optional<int> smallest;
  for (auto row = rows.rbegin(); row != rows.rend() && condition(*row); ++row) {
    smallest = row->participants;
  }
  return smallest;
}

TargetSize target_size(const std::vector<PowerRow>& rows, double target) {
  return {target,
          smallest_size(rows, [&](const PowerRow& row) { return row.estimated_power() >= target; }),
          smallest_size(rows, [&](const PowerRow& row) { return row.power.low >= target; })};
}

std::vector<std::string> warnings_of(const PowerReport& report) {
  std::vector<std::string> warnings;
  for (const PowerRow& row : report.rows) {
    if (verdict_of(row) == ErrorVerdict::excessive) {
      warnings.push_back(fmt::format(
          "With {} participants the type-I error exceeds the level of the test, so the test is not "
          "valid in this study.",
          row.participants));
    }
    if (row.attainable == 0.0) {
      warnings.push_back(fmt::format(
          "With {} participants the test cannot be significant in any run under the null "
          "hypothesis.",
          row.participants));
    }
  }
  const bool always_significant = std::ranges::all_of(report.rows, [](const PowerRow& row) {
    return row.significant.correct == row.significant.n;
  });
  if (always_significant) {
    warnings.emplace_back(
        "Every simulated study of every size was significant. If people are as sensitive as "
        "assumed, the smallest size suffices for this test; choose the size by the width of the "
        "interval.");
  }
  return warnings;
}

std::string condition_words(const PowerSetting& setting) {
  if (!setting.feels()) return "given the stated accuracies";
  return "given the assumed sensitivity";
}

std::string stated_null_sentence(const PowerReport& report) {
  if (report.setting.estimate != kDifferenceWords) {
    return "Type-I error: everybody guesses.";
  }
  return report.plan.margin > 0.0
             ? fmt::format(
                   "Type-I error: the first method is worse by {:.4g} points on average, with the "
                   "same spread.",
                   100.0 * report.plan.margin)
             : std::string("Type-I error: no difference on average, with the same spread.");
}

std::string null_sentence(const PowerReport& report) {
  if (!report.setting.feels()) return stated_null_sentence(report);
  if (report.plan.margin > 0.0) {
    return fmt::format(
        "Power: the methods feel the same; each presentation is felt as one of the two at random. "
        "Type-I error: likewise, but right answers with the first method are turned into wrong "
        "ones until it is worse by the margin, {:.4g} points.",
        100.0 * report.plan.margin);
  }
  return report.setting.estimate == kDifferenceWords
             ? "Type-I error: the methods feel the same; each presentation is felt as one of the "
               "two at random."
             : "Type-I error: participants feel a random texture instead of the presented one, "
               "with the same biases and lapses.";
}

constexpr const char* kExplorationErrorSentence =
    "Monte-Carlo intervals do not include the error due to these explorations and trainings, which "
    "are common to all studies. More runs do not reduce it; to estimate it, use other seeds.";

constexpr const char* kUnbalancedOrdersSentence =
    "Orders of this study do not present every class equally often: all numbers, especially type-I "
    "errors, hold only for the orders drawn by this study's seed; another seed gives other orders.";

std::vector<std::string> target_sentences(const PowerReport& report) {
  std::vector<std::string> sentences;
  for (const TargetSize& target : report.targets) {
    const std::string power = fmt::format("{:.0f} % power", 100.0 * target.target);
    if (!target.smallest) {
      sentences.push_back(power + ": no given size reaches it.");
    } else if (target.smallest_certain == target.smallest) {
      sentences.push_back(fmt::format("{}: {} participants.", power, *target.smallest));
    } else {
      sentences.push_back(fmt::format(
          "{}: {} participants by the estimate; {}.", power, *target.smallest,
          target.smallest_certain
              ? fmt::format("{} beyond Monte-Carlo error", *target.smallest_certain)
              : std::string("no size exceeds it beyond Monte-Carlo error; use more runs")));
    }
  }
  return sentences;
}

std::vector<std::string> method_sentences(const PowerReport& report) {
  const PowerPlan& plan = report.plan;
  std::vector<std::string> sentences;
  sentences.push_back(fmt::format(
      "{} simulated studies of each size and hypothesis, seed {}; every study has different "
      "participants; {}",
      plan.runs, plan.seed,
      !report.setting.feels() ? std::string("answers are drawn from the stated mean and spread. "
                                            "Device, hand and textures have no effect.")
                              : fmt::format("features are drawn from {} explorations of each "
                                            "stimulus and {} trainings through the servo.",
                                            plan.explorations, plan.trainings)));
  if (report.setting.feels()) sentences.push_back(kExplorationErrorSentence);
  sentences.push_back(null_sentence(report));
  if (!report.setting.has_fixed_counts) sentences.push_back(kUnbalancedOrdersSentence);
  const bool is_exact = std::ranges::any_of(
      report.rows, [](const PowerRow& row) { return row.attainable != row.level; });
  sentences.push_back(
      is_exact
          ? fmt::format("Attainable: the exact type-I error; with a finite number of sign patterns "
                        "p is never exactly {}.",
                        report.plan.level)
          : "Attainable: the level of the test, which a t test of proportions has approximately.");
  sentences.emplace_back("Monte-Carlo intervals are Wilson's at 95 %.");
  sentences.push_back("Interval width: of the 95 % t interval of the mean over participants.");
  return sentences;
}

std::string power_table(const PowerReport& report) {
  analysis::TextTable table({"participants", "runs", "power %", "MC interval", "type-I %", "MC 95%",
                             "attainable %", "error"});
  for (const PowerRow& row : report.rows) {
    table.add({std::to_string(row.participants), std::to_string(row.significant.n),
               power_per_cent(row.estimated_power()), power_range(row.power),
               power_per_cent(row.estimated_error()), power_range(row.type_one),
               power_per_cent(row.attainable), std::string(name_of(verdict_of(row)))});
  }
  return table.text();
}

std::string width_table(const PowerReport& report) {
  const bool is_comparison = report.setting.estimate == kDifferenceWords;
  analysis::TextTable table({"participants", is_comparison ? "difference" : "accuracy",
                             "SD of studies", "width", "MC error", "10%", "median", "90%"});
  for (const PowerRow& row : report.rows) {
    const WidthFigures& width = row.width;
    table.add({std::to_string(row.participants), power_per_cent(row.estimate),
               power_per_cent(row.estimate_sd), power_per_cent(width.mean),
               fmt::format("{:.2f}", 100.0 * width.standard_error), power_per_cent(width.lower),
               power_per_cent(width.median), power_per_cent(width.upper)});
  }
  return table.text();
}

using nlohmann::ordered_json;

ordered_json interval_json(const analysis::Interval& interval) {
  return ordered_json::array({interval.low, interval.high});
}

ordered_json size_object(const PowerRow& row) {
  ordered_json object{{"participants", row.participants}};
  object["power"] = {{"runs", row.significant.n},
                     {"significant", row.significant.correct},
                     {"p", row.estimated_power()},
                     {"interval", interval_json(row.power)}};
  object["type_one_error"] = {
      {"runs", row.false_alarms.n},   {"significant", row.false_alarms.correct},
      {"p", row.estimated_error()},   {"interval", interval_json(row.type_one)},
      {"attainable", row.attainable}, {"verdict", name_of(verdict_of(row))}};
  object["estimate"] = {{"mean", row.estimate}, {"sd_between_studies", row.estimate_sd}};
  object["interval_width"] = {
      {"mean", row.width.mean},
      {"standard_error", row.width.standard_error},
      {"quantiles",
       {{"0.1", row.width.lower}, {"0.5", row.width.median}, {"0.9", row.width.upper}}}};
  return object;
}

ordered_json target_object(const TargetSize& target) {
  const auto size = [](const std::optional<int>& participants) {
    return participants ? ordered_json(*participants) : ordered_json(nullptr);
  };
  return {{"power", target.target},
          {"smallest", size(target.smallest)},
          {"surely", size(target.smallest_certain)}};
}

ordered_json plan_object(const PowerPlan& plan) {
  return {
      {"participants", plan.participants}, {"runs", plan.runs},           {"seed", plan.seed},
      {"explorations", plan.explorations}, {"trainings", plan.trainings}, {"margin", plan.margin}};
}

ordered_json methods_object(const PowerReport& report) {
  return {{"monte_carlo_interval", "Wilson"},
          {"level", analysis::kConfidenceLevel},
          {"interval_width", "95 % t interval over participants"},
          {"sentences", method_sentences(report)}};
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

PowerCurve power_curve(const PowerReport& report) {
  PowerSeries series;
  for (const PowerRow& row : report.rows) {
    series.points.push_back({row.participants, row.significant});
  }
  return {report.setting.study, "significant primary test", {std::move(series)}};
}

std::string power_stamp(const PowerSetting& setting) {
  return "SIMULATED: power " + condition_words(setting);
}

std::string power_text(const PowerReport& report) {
  const std::string stamp = power_stamp(report.setting) + "\n";
  std::string text = analysis::simulated_on_line(report.setting.device) + stamp;
  text += analysis::wrapped("study    ", report.setting.study + ", " + report.setting.protocol);
  text += analysis::wrapped("test     ", report.setting.test);
  text += analysis::wrapped("assumed  ", report.setting.subject);
  text +=
      analysis::heading("Power and type-I error of the primary test", true) + power_table(report);
  text += analysis::heading(
              "Estimate, and width of its 95 % interval: mean, and quantiles over studies (points)",
              true) +
          width_table(report) + "\n";
  for (const std::string& sentence : target_sentences(report))
    text += analysis::wrapped("", sentence);
  for (const std::string& warning : report.warnings) text += analysis::wrapped("! ", warning);
  text += "\n";
  for (const std::string& sentence : method_sentences(report))
    text += analysis::wrapped("", sentence);
  return text + stamp;
}

std::string power_json(const PowerReport& report) {
  const PowerSetting& setting = report.setting;
  ordered_json object;
  object["simulated"] = true;
  object["stamp"] = "SIMULATED";
  object["simulated_on"] = setting.device;
  object["claim"] = power_stamp(setting);
  object["study"] = setting.study;
  object["protocol"] = setting.protocol;
  object["test"] = {
      {"words", setting.test}, {"level", report.plan.level}, {"estimate", setting.estimate}};
  object["assumed"] = setting.subject;
  object["plan"] = plan_object(report.plan);
  object["sizes"] = ordered_json::array();
  for (const PowerRow& row : report.rows) object["sizes"].push_back(size_object(row));
  object["targets"] = ordered_json::array();
  for (const TargetSize& target : report.targets) {
    object["targets"].push_back(target_object(target));
  }
  object["warnings"] = report.warnings;
  object["methods"] = methods_object(report);
  object["program"] = {
      {"version", setting.program}, {"seal", setting.seal}, {"fields", setting.fields}};
  return json_text(object);
}

}  // namespace touchtrial::planning::identification

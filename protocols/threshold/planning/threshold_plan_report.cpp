#include "analysis/planning/power_plan.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"
#include "core/strict_json.hpp"
#include "protocols/threshold/planning/threshold_plan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning::threshold {
namespace {

using analysis::Bounds;
using analysis::CensoredMean;
using nlohmann::ordered_json;

std::string db_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string share_text(const analysis::Proportion& share, const analysis::Interval& interval) {
  if (share.n == 0) return "-";
  return power_per_cent(*share.share()) + " " + power_range(interval);
}

std::string compared_words(const ThresholdPlanReport& report) {
  const std::vector<std::string>& words = report.pools.front().first.standards;
  return words[report.plan.difference->first] + " less " + words[report.plan.difference->second];
}

/// The standard error of a mean due to the finite pool. It is slightly too large, because people
/// beyond the levels also contribute information.
std::optional<double> pool_error(const CensoredMean& mean) {
  if (!mean.sd) return std::nullopt;
  return *mean.sd / std::sqrt(static_cast<double>(mean.exact));
}

std::vector<std::string> pool_cells(int trials, const std::string& name,
                                    const std::vector<Bounds>& people) {
  const CensoredMean mean = analysis::censored_mean(people);
  return {std::to_string(trials),
          name,
          std::to_string(mean.participants),
          std::to_string(mean.exact),
          db_text(mean.mean),
          db_text(mean.sd),
          db_text(pool_error(mean))};
}

std::string pools_text(const ThresholdPlanReport& report) {
  analysis::TextTable table(
      {"trials", "thresholds", "people", "known", "mean, dB", "SD", "error of mean"}, {1});
  std::string censored;
  for (const auto& [pool, rows] : report.pools) {
    for (std::size_t i = 0; i < pool.standards.size(); ++i) {
      table.add(pool_cells(pool.trials, pool.standards[i], thresholds_in(pool, i)));
    }
    if (report.plan.difference) {
      table.add(
          pool_cells(pool.trials, "difference", differences_in(pool, *report.plan.difference)));
    }
    censored += fmt::format(
        "  {} trials: {} of {} thresholds not known ({} below, {} above the levels, {} not "
        "determined); {} sessions not finished\n",
        pool.trials, pool.below + pool.above + pool.undetermined,
        pool.people.size() * pool.standards.size(), pool.below, pool.above, pool.undetermined,
        pool.unfinished);
  }
  return table.text() + censored;
}

std::string widths_text(const ThresholdPlanReport& report) {
  std::vector<std::string> header = {"trials",         "participants", "threshold",
                                     "half-width, dB", "90 % below",   "without, %"};
  if (report.plan.width_db) {
    header.push_back(fmt::format("within {:.4g} dB, %", *report.plan.width_db));
  }
  analysis::TextTable table(header, {2});
  const auto add = [&](const ThresholdRow& row, const std::string& name, const HalfWidths& width) {
    std::vector<std::string> cells = {std::to_string(row.trials),
                                      std::to_string(row.participants),
                                      name,
                                      db_text(width.median),
                                      db_text(width.upper),
                                      power_per_cent(width.without_interval.share().value_or(0.0))};
    if (report.plan.width_db) cells.push_back(share_text(width.narrow, width.narrow_interval));
    table.add(std::move(cells));
  };
  for (const auto& [pool, rows] : report.pools) {
    for (const ThresholdRow& row : rows) {
      for (std::size_t i = 0; i < row.standards.size(); ++i) {
        add(row, pool.standards[i], row.standards[i]);
      }
      if (row.difference) add(row, "difference", row.difference->width);
    }
  }
  return table.text();
}

std::string difference_text(const ThresholdPlanReport& report) {
  analysis::TextTable table({"trials", "participants", "power, %", "type-I error, %"}, {});
  for (const auto& [pool, rows] : report.pools) {
    for (const ThresholdRow& row : rows) {
      table.add({std::to_string(row.trials), std::to_string(row.participants),
                 share_text(row.difference->significant, row.difference->power),
                 share_text(row.difference->false_alarms, row.difference->type_one)});
    }
  }
  return table.text();
}

std::string stamp_of(const ThresholdPlanReport& report) {
  return "SIMULATED: intervals and power given the assumed sensitivity of " +
         report.setting.subject;
}

/// One warning per threshold and number of trials without a mean in the pool.
std::vector<std::string> warnings_without_mean(const ThresholdPlanReport& report) {
  std::vector<std::string> sentences;
  for (const auto& [pool, rows] : report.pools) {
    for (std::size_t i = 0; i < pool.standards.size(); ++i) {
      const CensoredMean mean = analysis::censored_mean(thresholds_in(pool, i));
      if (mean.lack != analysis::MissingReason::most) continue;
      sentences.push_back(fmt::format(
          "{}, {} trials: {} of {} simulated participants have a threshold within the levels, "
          "fewer than half, so there is no mean, and most studies would have none. Extend the "
          "levels, use a texture that is easier to feel, or use another device.",
          pool.standards[i], pool.trials, mean.exact, mean.participants));
    }
  }
  return sentences;
}

std::vector<std::string> sentences_of(const ThresholdPlanReport& report) {
  std::vector<std::string> sentences = {
      fmt::format(
          "Samples of each size: {}, drawn from the simulated participants with replacement. "
          "Monte-Carlo intervals (Wilson's, 95 %) refer only to sampling; for the error due to the "
          "finite pool see the error of the mean in the first table, or use other seeds.",
          report.plan.runs),
      "Half-width: of the 95 % interval of the mean over participants; its median and 90 % point "
      "over samples. Means include everybody, as in the report: people beyond the levels "
      "enter by the probability of a threshold there. Without: samples without an interval, "
      "because "
      "more than half of the people are beyond the levels. Add the participants that you expect to "
      "lose."};
  std::ranges::move(warnings_without_mean(report), std::back_inserter(sentences));
  if (report.plan.difference) {
    sentences.push_back(
        fmt::format("Power: test of the mean difference by the same likelihood, two-sided, level "
                    "{:.4g}; if everybody is within the levels it is the paired t test. Type-I "
                    "error: the same people, minus their mean difference.",
                    report.plan.alpha));
  }
  return sentences;
}

ordered_json number_json(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json share_json(const analysis::Proportion& share, const analysis::Interval& interval) {
  return {{"samples", share.n},
          {"count", share.correct},
          {"share", number_json(share.share())},
          {"low", interval.low},
          {"high", interval.high}};
}

ordered_json widths_json(const HalfWidths& width) {
  ordered_json object = {{"half_width_median", number_json(width.median)},
                         {"half_width_90", number_json(width.upper)},
                         {"samples_without_interval", width.without_interval.correct}};
  if (width.narrow.n > 0) object["within"] = share_json(width.narrow, width.narrow_interval);
  return object;
}

ordered_json mean_json(const std::string& name, const std::vector<Bounds>& people) {
  const CensoredMean mean = analysis::censored_mean(people);
  return {{"of", name},
          {"people", mean.participants},
          {"known", mean.exact},
          {"mean", number_json(mean.mean)},
          {"sd", number_json(mean.sd)},
          {"error_of_mean", number_json(pool_error(mean))}};
}

ordered_json threshold_row_json(const ThresholdPool& pool, const ThresholdRow& row) {
  ordered_json standards = ordered_json::array();
  for (std::size_t i = 0; i < row.standards.size(); ++i) {
    ordered_json one = {{"of", pool.standards[i]}};
    one.update(widths_json(row.standards[i]));
    standards.push_back(one);
  }
  ordered_json object = {{"participants", row.participants}, {"thresholds", standards}};
  if (row.difference) {
    ordered_json difference = widths_json(row.difference->width);
    difference["power"] = share_json(row.difference->significant, row.difference->power);
    difference["type_one_error"] =
        share_json(row.difference->false_alarms, row.difference->type_one);
    object["difference"] = difference;
  }
  return object;
}

ordered_json pool_json(const ThresholdPlanReport& report, const ThresholdPool& pool,
                       const std::vector<ThresholdRow>& rows) {
  ordered_json means = ordered_json::array();
  for (std::size_t i = 0; i < pool.standards.size(); ++i) {
    means.push_back(mean_json(pool.standards[i], thresholds_in(pool, i)));
  }
  ordered_json object = {{"trials", pool.trials},
                         {"people", pool.people.size()},
                         {"unfinished", pool.unfinished},
                         {"tracks", pool.tracks},
                         {"below", pool.below},
                         {"above", pool.above},
                         {"undetermined", pool.undetermined},
                         {"thresholds", means}};
  if (report.plan.difference) {
    object["difference"] =
        mean_json(compared_words(report), differences_in(pool, *report.plan.difference));
  }
  object["sizes"] = ordered_json::array();
  for (const ThresholdRow& row : rows) object["sizes"].push_back(threshold_row_json(pool, row));
  return object;
}

}  // namespace

PowerCurve threshold_power_curve(const ThresholdPlanReport& report) {
  const ThresholdPlan& plan = report.plan;
  if (!plan.difference && !plan.width_db) return {};
  PowerCurve curve{report.setting.study,
                   plan.difference
                       ? "significant difference, " + compared_words(report)
                       : fmt::format("95 % interval within {:.4g} dB of the mean threshold, {}",
                                     *plan.width_db, report.pools.front().first.standards.front()),
                   {}};
  for (const auto& [pool, rows] : report.pools) {
    PowerSeries series{report.pools.size() > 1 ? fmt::format("{} trials", pool.trials) : "", {}};
    for (const ThresholdRow& row : rows) {
      series.points.push_back({row.participants, plan.difference ? row.difference->significant
                                                                 : row.standards.front().narrow});
    }
    curve.series.push_back(std::move(series));
  }
  return curve;
}

std::string threshold_plan_text(const ThresholdPlanReport& report) {
  const std::string stamp = analysis::wrapped("", stamp_of(report));
  std::string text =
      analysis::simulated_on_line(report.setting.device) + stamp +
      fmt::format("study    {}\nunit     {}\n", report.setting.study, report.setting.unit);
  text +=
      analysis::heading("Simulated participants, by trials of a track", true) + pools_text(report);
  text += analysis::heading("Intervals of mean thresholds", true) + widths_text(report);
  if (report.plan.difference) {
    text +=
        analysis::heading("Difference: " + compared_words(report), true) + difference_text(report);
  }
  text += "\n";
  for (const std::string& sentence : sentences_of(report)) {
    text += analysis::wrapped("", sentence);
  }
  return text + stamp;
}

std::string threshold_plan_json(const ThresholdPlanReport& report) {
  const ThresholdPlan& plan = report.plan;
  ordered_json document = {{"simulated", true},
                           {"stamp", stamp_of(report)},
                           {"simulated_on", report.setting.device},
                           {"study", report.setting.study},
                           {"protocol", "threshold"},
                           {"subject", report.setting.subject},
                           {"unit", report.setting.unit},
                           {"seed", plan.seed},
                           {"samples", plan.runs},
                           {"width_db", number_json(plan.width_db)}};
  if (plan.difference) document["alpha"] = plan.alpha;
  document["trials"] = ordered_json::array();
  for (const auto& [pool, rows] : report.pools) {
    document["trials"].push_back(pool_json(report, pool, rows));
  }
  document["notes"] = sentences_of(report);
  return json_text(document);
}

}  // namespace touchtrial::planning::threshold

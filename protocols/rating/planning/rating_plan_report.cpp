#include "analysis/planning/power_plan.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/strict_json.hpp"
#include "protocols/rating/planning/rating_plan.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning::rating {
namespace {

using analysis::MeanEstimate;
using nlohmann::ordered_json;

/// The mean over the pool's participants who have this number.
MeanEstimate pool_mean(const PooledScale& scale, std::optional<double> PooledRating::*number) {
  std::vector<double> values;
  for (const PooledRating& one : scale.people) {
    if (one.*number) values.push_back(*(one.*number));
  }
  const double length = scale.ends.high - scale.ends.low;
  return analysis::participant_mean(values, number == &PooledRating::difference
                                                ? analysis::Interval{-length, length}
                                                : scale.ends);
}

/// The standard error of a mean due to the finite pool.
std::optional<double> pool_error(const MeanEstimate& mean) {
  if (!mean.sd) return std::nullopt;
  return *mean.sd / std::sqrt(static_cast<double>(mean.participants));
}

std::string number_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.3f}", *value) : "-";
}

std::string share_text(const analysis::Proportion& share, const analysis::Interval& interval) {
  return power_per_cent(*share.share()) + " " + power_range(interval);
}

std::string pool_text(const RatingPlanReport& report) {
  analysis::TextTable table({"scale", "ratings", "people", "mean", "SD", "error of mean"}, {0, 1});
  for (const PooledScale& scale : report.pool.scales) {
    const auto add = [&](const std::string& name, const MeanEstimate& mean) {
      table.add({scale.id, name, std::to_string(mean.participants), number_text(mean.mean),
                 number_text(mean.sd), number_text(pool_error(mean))});
    };
    add(report.setting.first, pool_mean(scale, &PooledRating::first));
    add(report.setting.second, pool_mean(scale, &PooledRating::second));
    add("difference", pool_mean(scale, &PooledRating::difference));
  }
  return table.text() +
         fmt::format("  participants who did not finish: {}\n", report.pool.unfinished);
}

std::string power_text(const RatingPlanReport& report) {
  analysis::TextTable table(
      {"scale", "participants", "power, %", "type-I error, %", "attainable, %", "interval width"});
  for (const RatingRow& row : report.rows) {
    for (std::size_t i = 0; i < row.scales.size(); ++i) {
      const DifferencePower& power = row.scales[i];
      table.add({report.pool.scales[i].id, std::to_string(row.participants),
                 share_text(power.significant, power.power),
                 share_text(power.false_alarms, power.type_one), power_per_cent(row.attainable),
                 number_text(power.width)});
    }
  }
  return table.text();
}

std::string compared_words(const RatingPlanReport& report) {
  return report.setting.first + " less " + report.setting.second;
}

std::string stamp_of(const RatingPlanReport& report) {
  return "SIMULATED: power given the assumed sensitivity of " + report.setting.subject;
}

std::vector<std::string> sentences_of(const RatingPlanReport& report) {
  std::vector<std::string> sentences = {
      fmt::format(
          "Samples of each size: {}, drawn from the simulated participants with replacement. "
          "Monte-Carlo intervals (Wilson's, 95 %) refer only to sampling; for the error due to the "
          "finite pool see the error of the mean in the first table, or use other seeds.",
          report.plan.runs),
      fmt::format("Power: sign flips of participants' differences, two-sided, level {:.4g}. Type-I "
                  "error: the same samples, each difference with a random sign. Attainable: its "
                  "maximum, given the finite number of sign patterns.",
                  report.plan.alpha),
      "Interval width: of the 95 % t interval of the mean difference, in units of the scale; its "
      "mean over samples. Participants who have not rated every texture with both methods are "
      "excluded from a sample, as in a study. Add the participants that you expect to lose."};
  if (report.pool.scales.size() > 1) {
    sentences.emplace_back(
        "Each scale is tested separately, without adjustment, so the study should state which "
        "scale "
        "is decisive.");
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

ordered_json mean_json(const std::string& name, const MeanEstimate& mean) {
  return {{"of", name},
          {"people", mean.participants},
          {"mean", number_json(mean.mean)},
          {"sd", number_json(mean.sd)},
          {"error_of_mean", number_json(pool_error(mean))}};
}

ordered_json scale_json(const RatingPlanReport& report, std::size_t index) {
  const PooledScale& scale = report.pool.scales[index];
  ordered_json object = {
      {"scale", scale.id},
      {"methods",
       {mean_json(report.setting.first, pool_mean(scale, &PooledRating::first)),
        mean_json(report.setting.second, pool_mean(scale, &PooledRating::second))}},
      {"difference",
       mean_json(compared_words(report), pool_mean(scale, &PooledRating::difference))}};
  object["sizes"] = ordered_json::array();
  for (const RatingRow& row : report.rows) {
    const DifferencePower& power = row.scales[index];
    ordered_json error = share_json(power.false_alarms, power.type_one);
    error["attainable"] = row.attainable;
    object["sizes"].push_back({{"participants", row.participants},
                               {"power", share_json(power.significant, power.power)},
                               {"type_one_error", error},
                               {"interval_width", number_json(power.width)},
                               {"samples_without_interval", power.without_interval}});
  }
  return object;
}

}  // namespace

PowerCurve rating_power_curve(const RatingPlanReport& report) {
  PowerCurve curve{report.setting.study, "significant difference, " + compared_words(report), {}};
  for (std::size_t i = 0; i < report.pool.scales.size(); ++i) {
    PowerSeries series{report.pool.scales.size() > 1 ? report.pool.scales[i].id : "", {}};
    for (const RatingRow& row : report.rows) {
      series.points.push_back({row.participants, row.scales[i].significant});
    }
    curve.series.push_back(std::move(series));
  }
  return curve;
}

std::string rating_plan_text(const RatingPlanReport& report) {
  const std::string stamp = analysis::wrapped("", stamp_of(report));
  std::string text = analysis::simulated_on_line(report.setting.device) + stamp +
                     fmt::format("study    {}\n", report.setting.study);
  text += analysis::heading("Simulated participants", true) + pool_text(report);
  text += analysis::heading("Difference: " + compared_words(report), true) + power_text(report);
  text += "\n";
  for (const std::string& sentence : sentences_of(report)) {
    text += analysis::wrapped("", sentence);
  }
  return text + stamp;
}

std::string rating_plan_json(const RatingPlanReport& report) {
  ordered_json document = {{"simulated", true},
                           {"stamp", stamp_of(report)},
                           {"simulated_on", report.setting.device},
                           {"study", report.setting.study},
                           {"protocol", "rating"},
                           {"subject", report.setting.subject},
                           {"seed", report.plan.seed},
                           {"samples", report.plan.runs},
                           {"alpha", report.plan.alpha},
                           {"people", report.pool.people},
                           {"unfinished", report.pool.unfinished}};
  document["scales"] = ordered_json::array();
  for (std::size_t i = 0; i < report.pool.scales.size(); ++i) {
    document["scales"].push_back(scale_json(report, i));
  }
  document["notes"] = sentences_of(report);
  return json_text(document);
}

}  // namespace touchtrial::planning::rating

#include "analysis/planning/power_words.hpp"
#include "analysis/statistics/chance_test.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::planning {
namespace {

using nlohmann::ordered_json;

ordered_json ends_of(const analysis::Interval& interval) {
  return ordered_json::array({interval.low, interval.high});
}

ordered_json size_object(const PowerRow& row) {
  ordered_json object{{"participants", row.participants}};
  object["power"] = {{"runs", row.significant.n},
                     {"significant", row.significant.correct},
                     {"p", row.significant.share().value_or(0.0)},
                     {"interval", ends_of(row.power)},
                     {"stopped_early", row.stopped_early}};
  object["type_one_error"] = {{"runs", row.false_alarms.n},
                              {"significant", row.false_alarms.correct},
                              {"p", row.false_alarms.share().value_or(0.0)},
                              {"interval", ends_of(row.type_one)},
                              {"attainable", row.attainable},
                              {"verdict", name_of(verdict_of(row))}};
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
          {"surely", size(target.surely)}};
}

ordered_json plan_object(const PowerPlan& plan) {
  return {{"participants", plan.participants}, {"runs", plan.runs},          {"seed", plan.seed},
          {"stop_early", plan.stop_early},     {"looks", looks_of(plan)},    {"servo", plan.servo},
          {"explorations", plan.explorations}, {"trainings", plan.trainings}};
}

ordered_json methods_object(const PowerReport& report) {
  return {{"power_interval", power_interval_name(report.plan)},
          {"power_level", power_level(report.plan)},
          {"type_one_interval", "Wilson"},
          {"type_one_level", analysis::kConfidenceLevel},
          {"interval_width", "95 % t interval over participants"},
          {"sentences", method_sentences(report)}};
}

}  // namespace

std::string power_json(const PowerReport& report) {
  const PowerSetting& setting = report.setting;
  ordered_json object;
  object["simulated"] = true;
  object["stamp"] = "SIMULATED";
  object["claim"] = kPowerStamp;
  object["study"] = setting.study;
  object["protocol"] = setting.protocol;
  object["test"] = {{"words", setting.test},
                    {"level", analysis::kSignificanceLevel},
                    {"estimate", setting.estimate}};
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
  return object.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace touchtrial::planning

#include "analysis/report/json_figures.hpp"

#include "analysis/report/bibliography.hpp"
#include "analysis/report/measure.hpp"

#include <cmath>

namespace touchtrial::analysis {

nlohmann::ordered_json figure_json(std::optional<double> figure) {
  if (!figure || !std::isfinite(*figure)) return nullptr;
  return *figure;
}

DataCell data_cell(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return flag(value.get<bool>());
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  return std::monostate{};
}

nlohmann::ordered_json interval_json(const Interval& interval) {
  return nlohmann::ordered_json::array({figure_json(interval.low), figure_json(interval.high)});
}

nlohmann::ordered_json interval_json(const std::optional<Interval>& interval) {
  if (!interval) return nullptr;
  return interval_json(*interval);
}

nlohmann::ordered_json statistic_json(const std::optional<TStatistic>& statistic) {
  if (!statistic) return nullptr;
  return {{"t", figure_json(statistic->t)},
          {"degrees_of_freedom", statistic->degrees_of_freedom},
          {"d", figure_json(statistic->d)},
          {"interval", interval_json(statistic->interval)}};
}

nlohmann::ordered_json quartiles_json(const Quartiles& quartiles) {
  return {{"n", quartiles.n},
          {"lower_quartile", figure_json(quartiles.lower)},
          {"median", figure_json(quartiles.median)},
          {"upper_quartile", figure_json(quartiles.upper)}};
}

std::optional<Interval> known_interval(const Interval& interval, const Proportion& trials) {
  return trials.n == 0 ? std::nullopt : std::optional(interval);
}

void put_mean(nlohmann::ordered_json& object, const MeanEstimate& mean) {
  object["mean"] = figure_json(mean.mean);
  object["interval"] = interval_json(mean.known_interval());
}

void put_stamp(nlohmann::ordered_json& object, bool simulated, const std::string& device) {
  object["simulated"] = simulated;
  if (!simulated) return;
  object["stamp"] = "SIMULATED";
  if (!device.empty()) object["simulated_on"] = device;
}

void put_state(nlohmann::ordered_json& object, const record::StudyState& state, bool pilot) {
  object["state"] = name_of(state);
  object["interim"] = (state.unblinded || state.question) && !state.closed;
  object["question_alone"] = state.question.has_value();
  object["pilot"] = pilot;
}

nlohmann::ordered_json statistics_json(const engine::GlcmStatistics& statistics) {
  return {{"asm", statistics.angular_second_moment},
          {"energy", statistics.energy},
          {"entropy", statistics.entropy},
          {"contrast", statistics.contrast},
          {"correlation", statistics.correlation}};
}

nlohmann::ordered_json glcm_json(const engine::GlcmTable& glcm) {
  nlohmann::ordered_json directions = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
    directions[std::to_string(engine::kGlcmOffsets[i].degrees)] = statistics_json(glcm[i]);
  }
  return directions;
}

void put_method(nlohmann::ordered_json& object, const std::string& method,
                const std::vector<std::string>& references) {
  object["method"] = method;
  object["references"] = references;
}

nlohmann::ordered_json with_method(nlohmann::ordered_json object, const std::string& method,
                                   const std::vector<std::string>& references) {
  put_method(object, method, references);
  return object;
}

nlohmann::ordered_json references_object() {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const Publication& publication : publications()) {
    // Only the cues cite Lin, with their own reference.
    if (publication.source != Source::lin && !publication.is_only_in_methods)
      all[std::string(publication.key)] = std::string(publication.text);
  }
  return all;
}

nlohmann::ordered_json registration_object(const study::Registration& registration) {
  return {{"hypothesis", registration.hypothesis},
          {"participants", registration.participants},
          {"stopping_rule", registration.stopping_rule},
          {"exclusions", registration.exclusions},
          {"primary_test", registration.primary_test}};
}

}  // namespace touchtrial::analysis

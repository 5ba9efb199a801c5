/// \file Numbers and other parts of reports as JSON. Do not include in public headers, because this
/// header includes the JSON library.
#pragma once

#include "analysis/outcomes/quality.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"
#include "core/strict_json.hpp"
#include "engine/metrics/glcm.hpp"
#include "study/session_plan.hpp"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

struct StudyHead;

/// The number, or null if it is missing or not finite.
[[nodiscard]] nlohmann::ordered_json figure_json(std::optional<double> figure);

/// [low, high]
[[nodiscard]] nlohmann::ordered_json interval_json(const Interval& interval);
/// [low, high], or null if there is no interval.
[[nodiscard]] nlohmann::ordered_json interval_json(const std::optional<Interval>& interval);

/// t, degrees_of_freedom, and d with its interval; null without a t.
[[nodiscard]] nlohmann::ordered_json statistic_json(const std::optional<TStatistic>& statistic);

/// \return the interval, or nothing if there are no trials
[[nodiscard]] std::optional<Interval> known_interval(const Interval& interval,
                                                     const Proportion& trials);

template <typename Range, typename ToJson>
[[nodiscard]] nlohmann::ordered_json array_json(const Range& range, ToJson to_json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const auto& element : range) all.push_back(to_json(element));
  return all;
}

/// Adds mean and interval to an object.
void put_mean(nlohmann::ordered_json& object, const MeanEstimate& mean);

[[nodiscard]] nlohmann::ordered_json statistics_json(const engine::GlcmStatistics& statistics);
/// Statistics by direction in degrees.
[[nodiscard]] nlohmann::ordered_json glcm_json(const engine::GlcmTable& glcm);

/// Adds `simulated`; if true also `stamp`, and the simulated device as `simulated_on`.
/// \param device  device_words (text_figures.hpp); may be empty
void put_stamp(nlohmann::ordered_json& object, bool simulated, const std::string& device = {});

/// Adds state ("collecting", "closed" or "unblinded"), interim (unblinded but not closed) and
/// pilot.
void put_state(nlohmann::ordered_json& object, const record::StudyState& state, bool pilot);

/// The first members of every report: study, protocol, stamp, state, participants and trials.
[[nodiscard]] nlohmann::ordered_json head_object(const StudyHead& head);

/// Prescription, flow, deviations and sessions.
[[nodiscard]] nlohmann::ordered_json collection_object(const Collection& collection);
[[nodiscard]] nlohmann::ordered_json registration_object(const study::Registration& registration);
[[nodiscard]] nlohmann::ordered_json quartiles_json(const Quartiles& quartiles);
/// Adds whether the report is public, participants' characteristics in bands, and exploration.
void put_people(nlohmann::ordered_json& object, const StudyHead& head);
/// Adds the registration, its answer, the prevalence, looks at outcomes and departures.
void put_registered(nlohmann::ordered_json& object, const StudyHead& head);
/// The publications that results.json cites, by key.
[[nodiscard]] nlohmann::ordered_json references_object();
/// Adds how a section's numbers were computed.
/// \param references  keys of references_object for the sources of the method
void put_method(nlohmann::ordered_json& object, const std::string& method,
                const std::vector<std::string>& references);
/// The object after put_method.
[[nodiscard]] nlohmann::ordered_json with_method(nlohmann::ordered_json object,
                                                 const std::string& method,
                                                 const std::vector<std::string>& references);
[[nodiscard]] nlohmann::ordered_json quality_object(const QualityReport& report);

}  // namespace touchtrial::analysis

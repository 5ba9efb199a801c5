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

/// The number, or null if it does not exist or is not finite.
[[nodiscard]] nlohmann::ordered_json figure_json(std::optional<double> figure);

/// [low, high]
[[nodiscard]] nlohmann::ordered_json interval_json(const Interval& interval);
/// [low, high], or null if there is no interval.
[[nodiscard]] nlohmann::ordered_json interval_json(const std::optional<Interval>& interval);

/// t, degrees_of_freedom, and d with its interval; null without a t.
[[nodiscard]] nlohmann::ordered_json statistic_json(const std::optional<TStatistic>& statistic);

/// \return the interval around a share of trials, or nothing if there are no trials
[[nodiscard]] std::optional<Interval> known(const Interval& interval, const Proportion& of);

/// An array of what `one` makes of each element.
template <typename Range, typename One>
[[nodiscard]] nlohmann::ordered_json array_json(const Range& range, One one) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const auto& element : range) all.push_back(one(element));
  return all;
}

/// Adds mean and interval to an object.
void put_mean(nlohmann::ordered_json& object, const MeanEstimate& mean);

[[nodiscard]] nlohmann::ordered_json statistics_json(const engine::GlcmStatistics& statistics);
/// The statistics by the degrees of their direction.
[[nodiscard]] nlohmann::ordered_json glcm_json(const engine::GlcmTable& glcm);

/// Adds whether the numbers come from simulated participants, and if so also a stamp and, unless it
/// is empty, for which device they hold ("simulated_on").
/// \param device  device_words (text_figures.hpp)
void put_stamp(nlohmann::ordered_json& object, bool simulated, const std::string& device = {});

/// Adds state ("collecting", "closed" or "unblinded"), interim (unblinded but not closed) and
/// pilot.
void put_state(nlohmann::ordered_json& object, const record::StudyState& state, bool pilot);

/// The members that begin every report: study, protocol, stamp, state, participants and trials.
[[nodiscard]] nlohmann::ordered_json head_object(const StudyHead& head);

/// How sessions were conducted: prescription, flow, deviations and sessions.
[[nodiscard]] nlohmann::ordered_json collection_object(const Collection& collection);
[[nodiscard]] nlohmann::ordered_json registration_object(const study::Registration& registration);
/// Quartiles with their n.
[[nodiscard]] nlohmann::ordered_json quartiles_json(const Quartiles& quartiles);
/// Adds whether the report is public, participants' characteristics in bands, and exploration.
void put_people(nlohmann::ordered_json& object, const StudyHead& head);
/// Adds what was registered, the answer, the prevalence, looks at outcomes and departures.
void put_registered(nlohmann::ordered_json& object, const StudyHead& head);
/// Every publication behind the report's statistics, by its key.
[[nodiscard]] nlohmann::ordered_json references_object();
/// Adds how a section's numbers were computed.
/// \param references  keys of references_object for the sources of the method
void put_method(nlohmann::ordered_json& object, const std::string& method,
                const std::vector<std::string>& references);
/// The object with that.
[[nodiscard]] nlohmann::ordered_json with_method(nlohmann::ordered_json object,
                                                 const std::string& method,
                                                 const std::vector<std::string>& references);
[[nodiscard]] nlohmann::ordered_json quality_object(const QualityReport& report);

}  // namespace touchtrial::analysis

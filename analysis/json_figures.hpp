/// \file How figures stand in JSON. Not for public headers: it shows the JSON library.
#pragma once

#include "analysis/quality.hpp"
#include "analysis/statistics/proportion.hpp"
#include "engine/metrics/glcm.hpp"
#include "protocols/design/session_plan.hpp"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

/// The number, or null where it does not exist or is not finite.
[[nodiscard]] nlohmann::ordered_json figure_json(std::optional<double> figure);

/// [low, high]
[[nodiscard]] nlohmann::ordered_json interval_json(const Interval& interval);
/// The same, or null where there is none.
[[nodiscard]] nlohmann::ordered_json interval_json(const std::optional<Interval>& interval);

/// An interval around a share of trials, or nothing without a trial.
[[nodiscard]] std::optional<Interval> known(const Interval& interval, const Proportion& of);

/// Adds n, correct and p to an object that may have begun with a name.
void put_proportion(nlohmann::ordered_json& object, const Proportion& proportion);

[[nodiscard]] nlohmann::ordered_json statistics_json(const engine::GlcmStatistics& statistics);

/// Says whether the figures come from simulated participants; if so, twice.
void put_stamp(nlohmann::ordered_json& object, bool simulated);

/// Adds state ("collecting", "closed", "unblinded"), interim (unblinded, but not closed) and pilot.
void put_state(nlohmann::ordered_json& object, const store::StudyState& state, bool pilot);

/// Indented, ending with a line feed; bytes that are no UTF-8 become replacement characters.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& object);

/// How sessions were conducted: prescription, flow, deviations, sessions.
[[nodiscard]] nlohmann::ordered_json collection_object(const Collection& collection);
[[nodiscard]] nlohmann::ordered_json registration_object(const design::Registration& registration);
/// Every source of the report's statistics, by its key.
[[nodiscard]] nlohmann::ordered_json references_object();
/// Adds how a section's numbers were had, and by whose account: keys of references_object.
void put_method(nlohmann::ordered_json& object, const std::string& method,
                const std::vector<std::string>& references);
[[nodiscard]] nlohmann::ordered_json quality_object(const QualityReport& report);

}  // namespace touchtrial::analysis

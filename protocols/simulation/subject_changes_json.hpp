/// \file The parts of subject_changes.hpp in a subject file. Private to protocols/simulation.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/simulation/subject_changes.hpp"

#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace touchtrial::simulation {

/// Reads a number if the object has it.
void read_number(const JsonObject& object, std::string_view key, const NumberRange& range,
                 double& number);

/// Missing keys have the defaults of the type.
/// \throws StudyError for an unknown key, a wrong type or an impossible value
[[nodiscard]] Learning learning_from(const JsonValue& value);
[[nodiscard]] SerialDependence serial_from(const JsonValue& value);
[[nodiscard]] Fatigue fatigue_from(const JsonValue& value);
[[nodiscard]] ThoughtTime thought_from(const JsonValue& value);
[[nodiscard]] GivenFunction given_function_from(const JsonValue& value);

/// With every key.
[[nodiscard]] nlohmann::ordered_json json_of(const Learning& learning);
[[nodiscard]] nlohmann::ordered_json json_of(const SerialDependence& serial);
[[nodiscard]] nlohmann::ordered_json json_of(const Fatigue& fatigue);
[[nodiscard]] nlohmann::ordered_json json_of(const ThoughtTime& thought);
[[nodiscard]] nlohmann::ordered_json json_of(const GivenFunction& given);

}  // namespace touchtrial::simulation

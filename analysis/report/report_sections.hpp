/// \file The sections of the report's JSON. Not for public headers: it shows the JSON library.
#pragma once

#include "analysis/report/report.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

[[nodiscard]] nlohmann::ordered_json method_object(const MethodReport& method,
                                                   const std::vector<std::string>& classes);
[[nodiscard]] nlohmann::ordered_json choice_object(const ChoiceModel& model);
[[nodiscard]] nlohmann::ordered_json reaction_array(const std::vector<ReactionTimes>& reaction,
                                                    const std::vector<std::string>& classes);
[[nodiscard]] nlohmann::ordered_json breakdowns_object(const std::vector<Breakdown>& breakdowns);
[[nodiscard]] nlohmann::ordered_json robustness_array(const std::vector<SubsetAccuracy>& subsets);
[[nodiscard]] nlohmann::ordered_json pairs_array(const StudyReport& report);
[[nodiscard]] nlohmann::ordered_json together_object(const MethodsTogether& together);
[[nodiscard]] nlohmann::ordered_json registration_object(const design::Registration& registration);
[[nodiscard]] nlohmann::ordered_json references_object();

/// Adds how a section's figures were had, and by whose account: keys of references_object.
void put_method(nlohmann::ordered_json& object, const std::string& method,
                const std::vector<std::string>& references);

}  // namespace touchtrial::analysis

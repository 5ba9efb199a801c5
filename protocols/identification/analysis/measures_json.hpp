/// \file Measures of one method in the report's JSON. Private to protocols/identification, because it
/// exposes the JSON library.
#pragma once

#include "protocols/identification/analysis/report.hpp"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis::identification {

[[nodiscard]] nlohmann::ordered_json reaction_array(const std::vector<ReactionTimes>& reaction,
                                                    const std::vector<std::string>& classes);
[[nodiscard]] nlohmann::ordered_json unbiased_object(const MethodReport& method,
                                                     const std::vector<std::string>& classes);
/// \return null without order effects
[[nodiscard]] nlohmann::ordered_json order_object(const std::optional<OrderEffects>& order);
/// \return null if confidence was not asked for
[[nodiscard]] nlohmann::ordered_json confidence_object(
    const std::optional<ConfidenceReport>& confidence);
[[nodiscard]] nlohmann::ordered_json breakdowns_object(const std::vector<Breakdown>& breakdowns);
[[nodiscard]] nlohmann::ordered_json robustness_array(const std::vector<SubsetAccuracy>& subsets);

}  // namespace touchtrial::analysis::identification

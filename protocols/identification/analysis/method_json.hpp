/// \file One method in the report's JSON. Private to protocols/identification, because it
/// exposes the JSON library.
#pragma once

#include "protocols/identification/analysis/report.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis::identification {

[[nodiscard]] nlohmann::ordered_json method_object(const MethodReport& method,
                                                   const std::vector<std::string>& classes);

}  // namespace touchtrial::analysis::identification

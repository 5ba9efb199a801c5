/// \file Questions in the study file. For sources only.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/design/session_plan.hpp"

#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial::design {

/// \param language  the study's: every text must have it
/// \throws StudyError with the place of what it cannot accept
[[nodiscard]] std::vector<Question> read_questions(const JsonValue& place,
                                                   const std::string& language);

/// As the study file writes them, every key explicit but "options" where there are none.
[[nodiscard]] nlohmann::json to_json(const std::vector<Question>& questions);

}  // namespace touchtrial::design

/// \file Answers to a questionnaire as they are sealed. Format: docs/data-dictionary.md.
#pragma once

#include "protocols/design/session_plan.hpp"

#include <string>
#include <vector>

namespace touchtrial::session {

/// One JSON object: a question's id to its answer; a choice as the option's index from 0, a number
/// as a number, everything else as text; what was left out is missing.
[[nodiscard]] std::string answers_to_json(const design::Questionnaire& questionnaire,
                                          const std::vector<std::string>& answers);

}  // namespace touchtrial::session

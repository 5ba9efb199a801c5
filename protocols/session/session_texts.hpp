/// \file What a session's people read, in the language of the session.
#pragma once

#include "protocols/design/session_plan.hpp"
#include "protocols/session/experimenter.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Of one session. What is empty is left out of it.
struct SessionTexts {
  std::vector<std::string> instructions;            ///< pages
  std::optional<design::Questionnaire> handedness;  ///< asked after the instructions
  std::optional<design::Questionnaire> closing;     ///< asked after the last trial
  std::vector<DaySheetItem> day_sheet;              ///< before the participant sits down
};

}  // namespace touchtrial::session

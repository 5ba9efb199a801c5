/// \file The stages before the first trial and after the last one: day sheet, instructions,
/// questions and practice.
#pragma once

#include "protocols/session/experimenter.hpp"
#include "study/session_plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// The texts of one session, in its language. Stages with empty texts are skipped.
struct SessionTexts {
  std::vector<std::string> instructions;           ///< pages, in order
  std::optional<study::Questionnaire> handedness;  ///< asked after the instructions
  std::optional<study::Questionnaire> closing;     ///< asked after the last trial
  std::vector<DaySheetItem> day_sheet;             ///< for the experimenter
};

class SessionDesk;

/// Runs the remaining stages before the first trial: day sheet, device, instructions, handedness,
/// practice, pictures.
/// \return whether trials may begin
[[nodiscard]] bool run_opening_stages(SessionDesk& desk);

/// Asks the closing questions after the last trial.
void ask_closing_questions(SessionDesk& desk);

}  // namespace touchtrial::session

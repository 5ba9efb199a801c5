/// \file What comes before the first trial and after the last one: day sheet, instructions,
/// questions and practice.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/session/experimenter.hpp"
#include "study/schedule.hpp"
#include "study/session_plan.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// The texts of one session, in its language. Empty members are left out of the session.
struct SessionTexts {
  std::vector<std::string> instructions;           ///< pages
  std::optional<study::Questionnaire> handedness;  ///< asked after the instructions
  std::optional<study::Questionnaire> closing;     ///< asked after the last trial
  std::vector<DaySheetItem> day_sheet;             ///< for the experimenter
};

struct PracticeRound {
  std::vector<std::string> labels;                    ///< by position
  std::vector<const engine::RenderingModel*> models;  ///< by position
  std::vector<int> order;                             ///< positions in the order of presentation
  /// Instead of models and order: trials with intervals, each with its target.
  std::vector<study::Presentation> trials{};
};

/// One participant's practice on textures that are not in the study. The fields of the models must
/// outlive this.
struct PracticeTextures {
  PlaneGeometry plane;
  int presentations = 0;       ///< of a round
  study::PracticePlan plan{};  ///< criterion and rounds
  /// Numbered from 1. The same number always gives the same round.
  std::function<PracticeRound(int round)> round;
};

class SessionDesk;

/// Goes through the stages before the first trial that are not done yet: day sheet, device,
/// instructions, handedness, practice, pictures.
/// \return whether trials may begin
[[nodiscard]] bool run_opening_stages(SessionDesk& desk);

/// Asks the closing questions of a session whose trials are done.
void ask_closing_questions(SessionDesk& desk);

}  // namespace touchtrial::session

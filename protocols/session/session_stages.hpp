/// \file What comes before the first trial and after the last. Private to the runner.
#pragma once

#include "protocols/session/session_desk.hpp"

namespace touchtrial::session {

/// Day sheet, device, instructions, handedness, practice, pictures: those that are not done yet.
/// \return whether trials may begin
[[nodiscard]] bool run_opening_stages(SessionDesk& desk);

/// The closing questions of a session whose trials are done.
void ask_closing_questions(SessionDesk& desk);

}  // namespace touchtrial::session

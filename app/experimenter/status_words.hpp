/// \file How a session stands, in one line.
#pragma once

#include "protocols/session/experimenter.hpp"

#include <string>

namespace touchtrial::app {

/// Participant, stage, trial, time, device, servo; what is not known yet is left out. Nothing in
/// it depends on a stimulus or on an outcome.
[[nodiscard]] std::string status_line(const session::SessionStatus& status);

/// The part that changes with what happens, and not with every second.
[[nodiscard]] std::string progress_words(const session::SessionStatus& status);

/// \name At most `columns` characters of a UTF-8 text
///@{
[[nodiscard]] std::string first_of(const std::string& text, int columns);
[[nodiscard]] std::string last_of(const std::string& text, int columns);
///@}

}  // namespace touchtrial::app

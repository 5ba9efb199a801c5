/// \file The status of a session in one line.
#pragma once

#include "protocols/session/experimenter.hpp"

#include <string>

namespace touchtrial::app {

/// Participant, stage, trial, time, device, and pressure and speed of the hand, or otherwise the
/// servo's timing, as far as known. Nothing in it depends on a stimulus or an outcome.
[[nodiscard]] std::string status_line(const session::SessionStatus& status);

/// "low", "right" or "high".
[[nodiscard]] const char* level_word(session::HandLevel level) noexcept;

/// Advice to the experimenter after the participant's comfort stop; empty if there was none.
[[nodiscard]] std::string stop_advice(const session::SessionStatus& status);

/// The part of the status that does not change every second.
[[nodiscard]] std::string progress_words(const session::SessionStatus& status);

/// \name The first or last characters of a UTF-8 text, at most `columns`
///@{
[[nodiscard]] std::string first_characters(const std::string& text, int columns);
[[nodiscard]] std::string last_characters(const std::string& text, int columns);
///@}

}  // namespace touchtrial::app

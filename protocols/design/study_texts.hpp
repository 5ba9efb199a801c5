/// \file Texts for people in the study file. For sources only.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/design/session_plan.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace touchtrial::design {

/// The languages that the program's own texts come in, and so those of a study's.
inline constexpr std::array<std::string_view, 2> kLanguages = {"en", "de"};

/// Whether a text has C0 (a line's end and a tab count too), DEL, or C1.
[[nodiscard]] bool has_control_character(std::string_view text);

/// One line, without blanks at its ends. \param longest  bytes
/// \throws StudyError if it is longer, or is empty, or has a control character
[[nodiscard]] std::string read_line(const JsonValue& place, std::size_t longest);

/// Paragraphs: may have line ends and be empty. \throws StudyError as above
[[nodiscard]] std::string read_paragraphs(const JsonValue& place, std::size_t longest);

/// A line in some of the languages. \throws StudyError if the study's language is not among them
[[nodiscard]] Translated read_translated(const JsonValue& place, const std::string& language);

}  // namespace touchtrial::design

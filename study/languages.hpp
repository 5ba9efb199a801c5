/// \file The texts that people read in a session, in each language of the program. The files of
/// config/texts are built in and read strictly; a study can replace some texts.
/// Format: docs/running-sessions.md, "Texts and languages".
#pragma once

#include "core/strict_json.hpp"
#include "study/session_plan.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::study {

/// The files of config/texts as they were when the program was built, English first.
[[nodiscard]] std::vector<std::string_view> language_files();

/// All texts of one language.
struct Language {
  std::string code;    ///< "fr"
  std::string name;    ///< in English: "French"
  bool draft = false;  ///< whether the texts are neither checked by native speakers nor validated
  Texts texts;
};

/// The codes of the built-in languages: the names of their files, in the same order.
[[nodiscard]] const std::vector<std::string_view>& language_codes();

/// The texts are parsed on first use. Thread-safe.
/// \param code  "de", "de-AT"
/// \return the language, or English if the program does not have it
[[nodiscard]] const Language& language_of(std::string_view code);

/// Whether the language writes numbers with a comma ("0,5").
[[nodiscard]] bool has_decimal_comma(std::string_view code) noexcept;

/// Reads a language file, which must have exactly the keys of the English one. Each text must have
/// the same words in braces and the same pictures as the English one, and "**" in pairs.
/// \param text  JSON
/// \throws StudyError with the source, the JSON pointer of the key, and the remedy
[[nodiscard]] Language parse_language(std::string_view text, const std::string& source);

/// Reads texts that replace some of a language's. They need not contain its pictures.
/// \throws StudyError as parse_language
[[nodiscard]] Texts read_texts(const JsonValue& place);

/// Checks that "**" comes in pairs and that each drawing exists.
/// \throws StudyError with the remedy
void check_markup(const JsonValue& place, const std::string& text);

/// The texts of a study in its language: the built-in ones, with the study's own replacements.
[[nodiscard]] Texts texts_of(const SessionPlan& session);

/// The name of the picture in a line "![](NAME)". Each picture of a page has a line of its own.
/// \return empty if the line is text
[[nodiscard]] std::string_view picture_in(std::string_view line) noexcept;

/// The name of the program's built-in drawing; all other names are paths.
inline constexpr std::string_view kHandDrawing = "drawing:hand";

/// Paths of the pictures in the study's own instructions, as written there, without duplicates.
[[nodiscard]] std::vector<std::string> picture_files(const SessionPlan& session);

/// A notice that the study's texts are a draft; empty if they are not.
/// \param code  the study's language
[[nodiscard]] std::string draft_notice(std::string_view code);

}  // namespace touchtrial::study

/// \file The texts that people read in a session: the program's own in each language, which are the
/// files of config/texts, built in and read strictly; and those of a study file. Sources of
/// questions and items: docs/experimenter.md.
#pragma once

#include "protocols/design/study.hpp"
#include "protocols/session/session_stages.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::app {

struct QuestionText {
  std::string id;
  std::string text;
  std::vector<std::string> options;  ///< empty: a free answer
};

/// All texts of a language. Keys are those of the file. Words in braces ("{limit}") stand for
/// values of a study.
struct LanguageTexts {
  std::string language;  ///< "en"
  std::map<std::string, std::string> instructions;
  std::vector<QuestionText> handedness;  ///< the inventory's items, all with the same options
  QuestionText pen_hand;
  std::vector<QuestionText> closing;
  std::map<std::string, std::string> day_sheet;
};

/// Reads a language file, in which every part must be present, and nothing else.
/// \throws StudyError with the source, the JSON pointer and the remedy
[[nodiscard]] LanguageTexts parse_language_texts(std::string_view text, const std::string& source);

/// \name The files of config/texts as they were when the program was built
///@{
[[nodiscard]] std::string_view english_texts_json() noexcept;
[[nodiscard]] std::string_view german_texts_json() noexcept;
///@}

/// The built-in languages, English first. Parsed once; thread-safe.
[[nodiscard]] const std::vector<LanguageTexts>& built_in_languages();

/// \param language  a code ("de", "de-AT")
/// \return its texts; English if the program does not have the language
[[nodiscard]] const LanguageTexts& texts_in(std::string_view language);

/// The study's pages of instructions replace the program's in the languages that have them. Its
/// closing questions and day-sheet items follow the program's; a question with the id of one of the
/// program's replaces it. Texts are English if the program does not have the study's language.
[[nodiscard]] session::SessionTexts session_texts(const design::Study& study);

}  // namespace touchtrial::app

/// \file The program's own texts in one language: a file of config/texts, read strictly.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::app {

struct QuestionText {
  std::string id;
  std::string text;
  std::vector<std::string> options;  ///< empty: answered in one's own words
};

/// All texts of a language. Keys are those of the file; words in braces ("{limit}") are filled in
/// for a study.
struct LanguageTexts {
  std::string language;  ///< "en"
  std::map<std::string, std::string> instructions;
  std::vector<QuestionText> handedness;  ///< the inventory's items, all with the same options
  QuestionText pen_hand;
  std::vector<QuestionText> closing;
  std::map<std::string, std::string> day_sheet;
  std::map<std::string, std::string> day_sheet_after;  ///< once the participant has left
};

/// Every part must be there and nothing else.
/// \throws StudyError with the source, the JSON pointer and the remedy
[[nodiscard]] LanguageTexts parse_language_texts(std::string_view text, const std::string& source);

/// The languages that are built in, English first. Parsed once; thread-safe.
[[nodiscard]] const std::vector<LanguageTexts>& built_in_languages();

/// That of the code ("de", "de-AT"); English if there is none.
[[nodiscard]] const LanguageTexts& texts_in(std::string_view language);

}  // namespace touchtrial::app

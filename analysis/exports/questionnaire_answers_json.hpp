/// \file Reads the answers to a questionnaire from their JSON. Private to exports. Format:
/// docs/data-dictionary.md, "Events", `questioned`.
#pragma once

#include <map>
#include <string>

namespace touchtrial::analysis {

/// Answers by the id of their question. Texts are left out, because they may name people.
struct QuestionnaireAnswers {
  std::map<std::string, int> choices;     ///< index of the option, or a whole number
  std::map<std::string, double> numbers;  ///< finite
};

/// \throws StoreError if the text is not a JSON object
[[nodiscard]] QuestionnaireAnswers answers_from_json(const std::string& text);

}  // namespace touchtrial::analysis

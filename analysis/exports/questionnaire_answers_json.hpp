/// \file A questionnaire's answers, out of their JSON. Private to exports.
/// Format: docs/data-dictionary.md, "Events", `questioned`.
#pragma once

#include <map>
#include <string>

namespace touchtrial::analysis {

/// By the question's id; texts are left out, as they may name people.
struct QuestionnaireAnswers {
  std::map<std::string, int> choices;     ///< index of the option; whole numbers too
  std::map<std::string, double> numbers;  ///< finite
};

/// \throws StoreError if the text is no JSON object
[[nodiscard]] QuestionnaireAnswers answers_from_json(const std::string& text);

}  // namespace touchtrial::analysis

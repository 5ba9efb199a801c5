#include "analysis/exports/questionnaire_answers_json.hpp"

#include "core/errors.hpp"

#include <limits>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

bool fits_int(const nlohmann::json& value) {
  return value.is_number_integer() && value >= 0 && value <= std::numeric_limits<int>::max();
}

}  // namespace

QuestionnaireAnswers answers_from_json(const std::string& text) {
  const nlohmann::json object = nlohmann::json::parse(text, nullptr, false);
  if (!object.is_object()) {
    throw StoreError("a questionnaire's answers are no JSON object; run `touchtrial verify`");
  }
  QuestionnaireAnswers answers;
  for (const auto& [id, value] : object.items()) {
    if (fits_int(value)) answers.choices[id] = value.get<int>();
    if (value.is_number()) answers.numbers[id] = value.get<double>();
  }
  return answers;
}

}  // namespace touchtrial::analysis

#include "protocols/session/questionnaire_json.hpp"

#include <charconv>
#include <optional>

#include <nlohmann/json.hpp>

namespace touchtrial::session {
namespace {

template <typename Number>
std::optional<Number> number_from(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return value;
}

nlohmann::json value_of(design::QuestionKind kind, const std::string& answer) {
  if (kind == design::QuestionKind::choice) {
    if (const auto index = number_from<int>(answer)) return *index;
  }
  if (kind == design::QuestionKind::number) {
    if (const auto number = number_from<double>(answer)) return *number;
  }
  return answer;
}

}  // namespace

std::string answers_to_json(const design::Questionnaire& questionnaire,
                            const std::vector<std::string>& answers) {
  nlohmann::json object = nlohmann::json::object();
  for (std::size_t i = 0; i < questionnaire.questions.size() && i < answers.size(); ++i) {
    if (answers[i].empty()) continue;
    const design::Question& question = questionnaire.questions[i];
    object[question.id] = value_of(question.kind, answers[i]);
  }
  // What people type is kept whatever it is; bytes that are no UTF-8 are replaced.
  return object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace touchtrial::session

#include "protocols/design/study_questions.hpp"

#include "protocols/design/study_names.hpp"
#include "protocols/design/study_sections.hpp"
#include "protocols/design/study_texts.hpp"

#include <algorithm>

namespace touchtrial::design {
namespace {

constexpr std::size_t kMostQuestions = 50;
constexpr std::size_t kMostOptions = 20;

void read_options(const JsonObject& object, const std::string& language, Question& question) {
  const auto options = object.find("options");
  if (question.kind != QuestionKind::choice) {
    if (options) options->refuse("belongs to a question of the kind choice; remove it");
    return;
  }
  for (const JsonValue& option : object.at("options").items(2, kMostOptions)) {
    question.options.push_back(read_translated(option, language));
  }
}

Question read_question(const JsonValue& place, const std::string& language) {
  const JsonObject object = place.object({"id", "kind", "text", "options", "required"});
  Question question;
  question.id = read_plain_name(object.at("id"));
  question.kind = object.at("kind").choice(kQuestionKindNames);
  question.text = read_translated(object.at("text"), language);
  read_options(object, language, question);
  if (const auto member = object.find("required")) question.required = member->truth();
  return question;
}

}  // namespace

std::vector<Question> read_questions(const JsonValue& place, const std::string& language) {
  std::vector<Question> questions;
  for (const JsonValue& item : place.items(0, kMostQuestions)) {
    Question question = read_question(item, language);
    if (std::ranges::count(questions, question.id, &Question::id) > 0) {
      item.refuse_below(
          "/id", in_quotes(question.id) + " is the id of another question; ids must be unique");
    }
    questions.push_back(std::move(question));
  }
  return questions;
}

nlohmann::json to_json(const std::vector<Question>& questions) {
  nlohmann::json list = nlohmann::json::array();
  for (const Question& question : questions) {
    nlohmann::json item = {{"id", question.id},
                           {"kind", word_for(kQuestionKindNames, question.kind)},
                           {"text", question.text},
                           {"required", question.required}};
    if (!question.options.empty()) item["options"] = question.options;
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace touchtrial::design

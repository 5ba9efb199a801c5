#include "analysis/outcomes/answers.hpp"

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

constexpr const char* kHandedness = "handedness";
constexpr const char* kClosing = "closing";

void add_answers(const record::SessionRow& row, const std::string& questionnaire,
                 const std::string& text, std::vector<QuestionAnswer>& all) {
  const nlohmann::ordered_json object = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!object.is_object()) {
    throw StoreError("a questionnaire's answers are not a JSON object; run `touchtrial verify`");
  }
  for (const auto& [id, value] : object.items()) {
    QuestionAnswer answer{row.participant, row.session, questionnaire, id};
    if (value.is_number()) answer.number = value.get<double>();
    if (value.is_string()) answer.words = value.get<std::string>();
    all.push_back(std::move(answer));
  }
}

bool is_option(double number, std::size_t options) {
  return number >= 0.0 && number < static_cast<double>(options);
}

/// The answers to one question, by counted participant.
using AnswersByParticipant = std::map<std::string, const QuestionAnswer*>;

QuestionSummary question_summary(const std::string& id, const study::Question* question,
                                 const AnswersByParticipant& answers, const Outcomes& outcomes) {
  const bool is_public = outcomes.collection.is_public;
  QuestionSummary summary;
  summary.question = id;
  summary.answered = static_cast<int>(answers.size());
  const bool is_number = answers.begin()->second->number.has_value();
  summary.kind = question != nullptr ? question->kind
                 : is_number         ? study::QuestionKind::number
                                     : study::QuestionKind::text;
  const std::string& language = outcomes.design.session.language;
  if (question != nullptr) {
    summary.wording = in_language(question->text, language);
    for (const study::Translated& option : question->options) {
      summary.options.push_back({in_language(option, language), 0});
    }
  }
  std::vector<double> numbers;
  for (const auto& [participant, answer] : answers) {
    if (summary.kind == study::QuestionKind::text) {
      if (!answer->words.empty()) summary.texts.emplace_back(participant, answer->words);
    } else if (answer->number) {
      numbers.push_back(*answer->number);
    }
  }
  if (summary.kind == study::QuestionKind::choice) {
    for (const double number : numbers) {
      if (is_option(number, summary.options.size())) {
        ++summary.options[static_cast<std::size_t>(number)].people;
      }
    }
    if (is_public) summary.others = remove_small_bands(summary.options, 0);
  } else if (!is_public || summary.answered >= kMinBandPeople) {
    summary.numbers = quartiles(std::move(numbers));
  }
  return summary;
}

}  // namespace

std::vector<QuestionAnswer> open_answers(const StudyEvents& study, const SessionKeys& keys) {
  std::map<int, record::SessionRow> rows;
  for (const record::SessionRow& row : study.store().sessions()) rows[row.session] = row;
  std::vector<QuestionAnswer> all;
  constexpr std::array kAnswerKinds = {record::EventKind::questioned};
  study.for_each_of(kAnswerKinds, [&](const record::Event& event) {
    const auto key = keys.find(event.session);
    if (key == keys.end() || !key->second.participant) return;
    add_answers(rows.at(event.session), record::from_json<record::TextBody>(event.body).text,
                open_event(event, *key->second.participant).secret, all);
  });
  return all;
}

Questionnaires closing_questionnaires(const study::Study& study) {
  return {{kClosing, study.session.closing_questions}};
}

const study::Question* question_of(const Questionnaires& questionnaires,
                                   const QuestionAnswer& answer) {
  for (const study::Questionnaire& questionnaire : questionnaires) {
    if (questionnaire.name != answer.questionnaire) continue;
    const auto found =
        std::ranges::find(questionnaire.questions, answer.question, &study::Question::id);
    if (found != questionnaire.questions.end()) return &*found;
  }
  return nullptr;
}

std::string in_language(const study::Translated& text, const std::string& language) {
  if (text.empty()) return "";
  auto found = text.find(language);
  if (found == text.end()) found = text.find("en");
  return (found == text.end() ? text.begin() : found)->second;
}

std::string words_of(const QuestionAnswer& answer, const study::Question* question,
                     const std::string& language) {
  if (!answer.number) return answer.words;
  if (question == nullptr || question->kind != study::QuestionKind::choice) return "";
  if (!is_option(*answer.number, question->options.size())) return "";
  return in_language(question->options[static_cast<std::size_t>(*answer.number)], language);
}

bool is_demographic(const std::string& questionnaire, const std::string& question) {
  constexpr std::array<std::string_view, 3> kDemographicQuestions{"age", "sex", "gender"};
  return questionnaire == kHandedness ||
         std::ranges::find(kDemographicQuestions, question) != kDemographicQuestions.end();
}

std::vector<QuestionSummary> question_summaries(const Outcomes& outcomes) {
  std::set<int> counted;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (session.counted) counted.insert(session.row.session);
  }
  std::map<std::string, AnswersByParticipant> by_question;
  for (const QuestionAnswer& answer : outcomes.answers) {
    if (!counted.contains(answer.session)) continue;
    if (is_demographic(answer.questionnaire, answer.question)) continue;
    by_question[answer.question][answer.participant] = &answer;
  }
  std::vector<QuestionSummary> summaries;
  const auto add = [&](const std::string& id, const study::Question* question) {
    const auto found = by_question.find(id);
    if (found == by_question.end()) return;
    summaries.push_back(question_summary(id, question, found->second, outcomes));
    by_question.erase(found);
  };
  for (const study::Questionnaire& questionnaire : outcomes.questionnaires) {
    for (const study::Question& question : questionnaire.questions) add(question.id, &question);
  }
  while (!by_question.empty()) add(std::string(by_question.begin()->first), nullptr);
  return summaries;
}

}  // namespace touchtrial::analysis

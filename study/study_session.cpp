/// \file The study file's "session": its texts, its questions, and its other settings.
#include "core/labels.hpp"
#include "study/languages.hpp"
#include "study/study_sections.hpp"

#include <algorithm>

namespace touchtrial::study {
namespace {

constexpr std::size_t kLongestQuestion = 500;  // bytes

void check_length(const JsonValue& place, const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return;
  place.refuse("has " + std::to_string(text.size()) + " bytes, must have at most " +
               std::to_string(longest) + "; shorten it");
}

constexpr std::size_t kMaxQuestions = 50;
constexpr std::size_t kMaxOptions = 20;

void read_options(const JsonObject& object, const std::string& language, Question& question) {
  const auto options = object.find("options");
  if (question.kind != QuestionKind::choice) {
    if (options) options->refuse("belongs to a question of the kind choice; remove it");
    return;
  }
  for (const JsonValue& option : object.at("options").items(2, kMaxOptions)) {
    question.options.push_back(read_translated(option, language));
  }
}

void read_range(const JsonObject& object, Question& question) {
  constexpr double kLargest = 1e9;
  const auto read = [&](const char* key, std::optional<double>& bound) {
    const auto member = object.find(key);
    if (!member) return;
    if (question.kind != QuestionKind::number) {
      member->refuse("belongs to a question of the kind number; remove it");
    }
    bound = member->number({.low = -kLargest, .high = kLargest});
    if (question.min && question.max && *question.min > *question.max) {
      member->refuse("is " + number_text(*bound) + ", less than min, " +
                     number_text(*question.min) + "; no number is between them");
    }
  };
  read("min", question.min);
  read("max", question.max);
}

Question read_question(const JsonValue& place, const std::string& language) {
  const JsonObject object =
      place.object({"id", "kind", "text", "options", "required", "min", "max"});
  Question question;
  question.id = read_plain_name(object.at("id"));
  question.kind = object.at("kind").choice(kQuestionKindNames);
  question.text = read_translated(object.at("text"), language);
  read_options(object, language, question);
  read_range(object, question);
  if (const auto member = object.find("required")) question.required = member->truth();
  return question;
}

constexpr std::size_t kMaxPages = 20;
constexpr std::size_t kLongestPage = 4000;  // bytes
constexpr std::size_t kMaxItems = 50;
constexpr std::size_t kLongestItem = 200;  // bytes
constexpr std::size_t kLongestName = 64;   // bytes

void read_truth(const JsonObject& object, std::string_view key, bool& truth) {
  if (const auto member = object.find(key)) truth = member->truth();
}

std::vector<std::string> read_pages(const JsonValue& place) {
  std::vector<std::string> pages;
  for (const JsonValue& item : place.items(1, kMaxPages)) {
    pages.push_back(read_paragraphs(item, kLongestPage));
    if (pages.back().empty()) item.refuse("is empty; write a page, or remove it");
    check_markup(item, pages.back());
  }
  return pages;
}

void read_instructions(const JsonValue& place, SessionPlan& session) {
  const JsonObject object = place.object(language_codes());
  for (const std::string_view code : language_codes()) {
    if (const auto member = object.find(code)) {
      session.instructions[std::string(code)] = read_pages(*member);
    }
  }
  if (!session.instructions.empty() && !session.instructions.contains(session.language)) {
    place.refuse_below("/" + session.language, "is missing, the study's language; add its pages");
  }
}

void read_own_texts(const JsonValue& place, SessionPlan& session) {
  const JsonObject object = place.object(language_codes());
  for (const std::string_view code : language_codes()) {
    const auto member = object.find(code);
    if (!member) continue;
    Texts texts = read_texts(*member);
    if (!texts.empty()) session.texts[std::string(code)] = std::move(texts);
  }
}

MaskingPlan read_masking(const JsonValue& place) {
  const JsonObject object = place.object({"wanted", "level_dbfs"});
  MaskingPlan masking;
  read_truth(object, "wanted", masking.wanted);
  if (const auto member = object.find("level_dbfs")) {
    masking.level_dbfs = member->number({.low = -90.0, .high = 0.0});
  }
  return masking;
}

int read_confidence(const JsonValue& place) {
  constexpr int kMaxLevels = 9;
  const auto levels = static_cast<int>(place.integer(0, kMaxLevels));
  if (levels == 1) place.refuse("is 1, must be 0 (not asked) or from 2 to 9 levels");
  return levels;
}

std::vector<std::string> read_day_sheet(const JsonValue& place) {
  std::vector<std::string> sheet;
  for (const JsonValue& item : place.items(0, kMaxItems)) {
    std::string line = read_line(item, kLongestItem);
    if (std::ranges::count(sheet, line) > 0) {
      item.refuse(in_quotes(line) + " is there twice; list it once");
    }
    sheet.push_back(std::move(line));
  }
  return sheet;
}

/// Reads a version or a number, as a line that may be empty.
void read_name(const JsonObject& object, std::string_view key, std::string& name) {
  const auto member = object.find(key);
  if (member && !member->text().empty()) name = read_line(*member, kLongestName);
}

}  // namespace

std::string read_line(const JsonValue& place, std::size_t longest) {
  const std::string& line = place.text();
  if (line.empty()) place.refuse("is empty; write something, or leave it out");
  check_length(place, line, longest);
  if (has_control_character(line)) place.refuse("has a control character; remove it");
  if (line.front() == ' ' || line.back() == ' ') {
    place.refuse("begins or ends with a blank; remove it");
  }
  return line;
}

std::string read_paragraphs(const JsonValue& place, std::size_t longest) {
  const std::string& text = place.text();
  check_length(place, text, longest);
  std::string without_ends = text;
  std::erase(without_ends, '\n');
  if (has_control_character(without_ends)) {
    place.refuse("has a control character other than a line's end; remove it");
  }
  return text;
}

Translated read_translated(const JsonValue& place) {
  const JsonObject object = place.object(language_codes());
  Translated text;
  for (const std::string_view code : language_codes()) {
    if (const auto member = object.find(code)) {
      text[std::string(code)] = read_line(*member, kLongestQuestion);
    }
  }
  return text;
}

Translated read_translated(const JsonValue& place, const std::string& language) {
  Translated text = read_translated(place);
  if (!text.contains(language)) {
    place.refuse_below("/" + language, "is missing, the study's language; add it");
  }
  return text;
}

std::vector<Question> read_questions(const JsonValue& place, const std::string& language) {
  std::vector<Question> questions;
  for (const JsonValue& item : place.items(0, kMaxQuestions)) {
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
                           {"kind", name_in(kQuestionKindNames, question.kind)},
                           {"text", question.text},
                           {"required", question.required}};
    if (!question.options.empty()) item["options"] = question.options;
    if (question.min) item["min"] = *question.min;
    if (question.max) item["max"] = *question.max;
    list.push_back(std::move(item));
  }
  return list;
}

SessionPlan read_session(const JsonValue& place) {
  const JsonObject object =
      place.object({"language", "instructions", "texts", "text_scale", "high_contrast", "sight",
                    "masking", "handedness", "confidence", "day_sheet", "consent_version",
                    "ethics_number", "closing_questions", "closing"});
  SessionPlan session;
  if (const auto member = object.find("language")) {
    session.language = language_codes()[member->choice(language_codes())];
  }
  if (const auto member = object.find("instructions")) read_instructions(*member, session);
  if (const auto member = object.find("texts")) read_own_texts(*member, session);
  if (const auto member = object.find("text_scale")) {
    session.text_scale = member->number({.low = 1.0, .high = kMaxTextScale});
  }
  read_truth(object, "high_contrast", session.high_contrast);
  if (const auto member = object.find("sight")) session.sight = member->choice(kSightNames);
  if (const auto member = object.find("masking")) session.masking = read_masking(*member);
  read_truth(object, "handedness", session.handedness);
  if (const auto member = object.find("confidence")) {
    session.confidence_levels = read_confidence(*member);
  }
  if (const auto member = object.find("day_sheet")) session.day_sheet = read_day_sheet(*member);
  read_name(object, "consent_version", session.consent_version);
  read_name(object, "ethics_number", session.ethics_number);
  if (const auto member = object.find("closing_questions")) {
    session.closing_questions = read_questions(*member, session.language);
  }
  read_truth(object, "closing", session.closing);
  return session;
}

nlohmann::json to_json(const SessionPlan& session) {
  nlohmann::json instructions = nlohmann::json::object();
  for (const auto& [language, pages] : session.instructions) instructions[language] = pages;
  nlohmann::json text = {
      {"language", session.language},
      {"instructions", instructions},
      {"sight", name_in(kSightNames, session.sight)},
      {"masking", {{"wanted", session.masking.wanted}, {"level_dbfs", session.masking.level_dbfs}}},
      {"handedness", session.handedness},
      {"confidence", session.confidence_levels},
      {"day_sheet", session.day_sheet},
      {"consent_version", session.consent_version},
      {"ethics_number", session.ethics_number},
      {"closing_questions", to_json(session.closing_questions)},
      {"closing", session.closing}};
  const SessionPlan usual;
  if (session.texts != usual.texts) text["texts"] = session.texts;
  if (session.text_scale != usual.text_scale) text["text_scale"] = session.text_scale;
  if (session.high_contrast) text["high_contrast"] = true;
  return text;
}

}  // namespace touchtrial::study

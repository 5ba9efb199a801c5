#include "app/texts/study_texts.hpp"

#include "core/strict_json.hpp"
#include "protocols/design/protocol.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

constexpr std::array<std::string_view, 10> kInstructions{
    "welcome",          "hand",       "curtain",  "blindfold", "time_fade",
    "time_no_response", "confidence", "practice", "masking",   "comfort"};
constexpr std::array<std::string_view, 12> kDaySheet{
    "warm_up", "calibration", "gravity",    "fixture",       "placement", "curtain",
    "labels",  "blindfold",   "headphones", "masking_level", "consent",   "consent_version"};
constexpr std::size_t kMost = 16;

std::string read_text(const JsonValue& value) {
  std::string text = value.text();
  if (text.empty()) value.refuse("is empty; write the text");
  return text;
}

std::map<std::string, std::string> read_parts(const JsonValue& value,
                                              std::span<const std::string_view> names) {
  const JsonObject object = value.object(names);
  std::map<std::string, std::string> parts;
  for (const std::string_view name : names) {
    parts.emplace(std::string(name), read_text(object.at(name)));
  }
  return parts;
}

/// What every study says, and a page for each protocol that does not bring its own.
std::vector<std::string_view> instruction_names() {
  std::vector<std::string_view> names(kInstructions.begin(), kInstructions.end());
  for (const design::Protocol* protocol : design::protocols()) {
    if (protocol->instruction().empty()) names.push_back(protocol->name());
  }
  return names;
}

std::vector<std::string> read_options(const JsonValue& value) {
  std::vector<std::string> options;
  for (const JsonValue& item : value.items(2, kMost)) options.push_back(read_text(item));
  return options;
}

std::vector<QuestionText> read_questions(const JsonValue& value) {
  std::vector<QuestionText> questions;
  for (const JsonValue& item : value.items(1, kMost)) {
    const JsonObject object = item.object({"id", "text", "options"});
    QuestionText& question = questions.emplace_back();
    question.id = read_text(object.at("id"));
    question.text = read_text(object.at("text"));
    if (const auto options = object.find("options")) question.options = read_options(*options);
  }
  return questions;
}

std::vector<QuestionText> read_inventory(const JsonObject& object) {
  std::vector<QuestionText> items = read_questions(object.at("handedness"));
  const std::vector<std::string> options = read_options(object.at("handedness_options"));
  for (QuestionText& item : items) item.options = options;
  return items;
}

QuestionText read_pen_hand(const JsonValue& value) {
  const JsonObject object = value.object({"text", "options"});
  return {"pen-hand", read_text(object.at("text")), read_options(object.at("options"))};
}

}  // namespace

LanguageTexts parse_language_texts(std::string_view text, const std::string& source) {
  const JsonObject object = parse_strict_json(text, source)
                                .object({"language", "instructions", "handedness",
                                         "handedness_options", "pen_hand", "closing", "day_sheet"});
  LanguageTexts texts;
  texts.language = read_text(object.at("language"));
  texts.instructions = read_parts(object.at("instructions"), instruction_names());
  texts.handedness = read_inventory(object);
  texts.pen_hand = read_pen_hand(object.at("pen_hand"));
  texts.closing = read_questions(object.at("closing"));
  texts.day_sheet = read_parts(object.at("day_sheet"), kDaySheet);
  return texts;
}

const std::vector<LanguageTexts>& built_in_languages() {
  static const std::vector<LanguageTexts> languages{
      parse_language_texts(english_texts_json(), "the program's English texts"),
      parse_language_texts(german_texts_json(), "the program's German texts")};
  return languages;
}

const LanguageTexts& texts_in(std::string_view language) {
  for (const LanguageTexts& texts : built_in_languages()) {
    if (language.substr(0, 2) == texts.language) return texts;
  }
  return built_in_languages().front();
}

namespace {

using Words = std::map<std::string, std::string>;

/// Replaces the words in braces.
std::string filled(std::string text, const Words& words) {
  for (const auto& [name, word] : words) {
    const std::string place = "{" + name + "}";
    for (auto at = text.find(place); at != text.npos; at = text.find(place, at + word.size())) {
      text.replace(at, place.size(), word);
    }
  }
  return text;
}

std::string seconds_text(double seconds, const std::string& language) {
  std::string text = fmt::format("{:g}", seconds);
  if (language == "de") std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

Words words_for(const design::Study& study, const LanguageTexts& texts) {
  return {{"pictures", std::to_string(study.classes.size())},
          {"limit", seconds_text(study.trials.explore_limit_s, texts.language)},
          {"confidence", std::to_string(study.session.confidence_levels)},
          {"consent", study.session.consent_version}};
}

/// The parts of the instructions on each page.
std::vector<std::vector<std::string>> pages_for(const design::Study& study) {
  std::vector<std::string> rules{
      study.trials.on_timeout == design::OnTimeout::fade ? "time_fade" : "time_no_response"};
  if (study.session.confidence_levels > 0) rules.push_back("confidence");
  if (study.session.masking.wanted) rules.push_back("masking");
  std::vector<std::vector<std::string>> pages{
      {"welcome"},
      {study.protocol_name()},
      {"hand"},
      {study.session.sight == design::Sight::blindfold ? "blindfold" : "curtain"},
      rules};
  if (study.trials.practice > 0) pages.push_back({"practice"});
  pages.push_back({"comfort"});
  return pages;
}

/// A part of the language's texts, or what the protocol says itself.
std::string part_of(const design::Study& study, const LanguageTexts& texts,
                    const std::string& part) {
  const auto found = texts.instructions.find(part);
  return found == texts.instructions.end() ? study.protocol->instruction() : found->second;
}

std::vector<std::string> own_instructions(const design::Study& study, const LanguageTexts& texts) {
  const Words words = words_for(study, texts);
  std::vector<std::string> pages;
  for (const std::vector<std::string>& parts : pages_for(study)) {
    std::string& page = pages.emplace_back();
    for (const std::string& part : parts) {
      if (!page.empty()) page += "\n\n";
      page += filled(part_of(study, texts, part), words);
    }
  }
  return pages;
}

std::vector<std::string> instructions(const design::Study& study, const LanguageTexts& texts) {
  const auto given = study.session.instructions.find(study.session.language);
  if (given != study.session.instructions.end() && !given->second.empty()) return given->second;
  return own_instructions(study, texts);
}

/// One question in all built-in languages.
/// \param of  returns a language's wording
template <typename Wording>
design::Question question_in_all(Wording of) {
  design::Question question;
  for (const LanguageTexts& texts : built_in_languages()) {
    const QuestionText& wording = of(texts);
    question.id = wording.id;
    question.kind =
        wording.options.empty() ? design::QuestionKind::text : design::QuestionKind::choice;
    question.text[texts.language] = wording.text;
    question.options.resize(wording.options.size());
    for (std::size_t i = 0; i < wording.options.size(); ++i) {
      question.options[i][texts.language] = wording.options[i];
    }
  }
  return question;
}

std::vector<design::Question> questions_in_all(std::vector<QuestionText> LanguageTexts::*list) {
  std::vector<design::Question> questions;
  for (std::size_t i = 0; i < (built_in_languages().front().*list).size(); ++i) {
    questions.push_back(question_in_all(
        [&](const LanguageTexts& texts) -> const QuestionText& { return (texts.*list).at(i); }));
  }
  return questions;
}

design::Questionnaire handedness_inventory() {
  design::Questionnaire inventory{"handedness", questions_in_all(&LanguageTexts::handedness)};
  design::Question& hand = inventory.questions.emplace_back(question_in_all(
      [](const LanguageTexts& texts) -> const QuestionText& { return texts.pen_hand; }));
  hand.required = true;
  return inventory;
}

void join(std::vector<design::Question>& questions, const design::Question& given) {
  const auto same = std::ranges::find(questions, given.id, &design::Question::id);
  if (same == questions.end()) {
    questions.push_back(given);
  } else {
    *same = given;
  }
}

std::optional<design::Questionnaire> closing_questions(const design::SessionPlan& plan) {
  design::Questionnaire closing{"closing", {}};
  if (plan.closing) closing.questions = questions_in_all(&LanguageTexts::closing);
  for (const design::Question& given : plan.closing_questions) join(closing.questions, given);
  if (closing.questions.empty()) return std::nullopt;
  return closing;
}

/// Each item's deviation code (for skipping it) and its key in a language file.
std::vector<std::pair<std::string, std::string>> items_for(const design::SessionPlan& plan) {
  std::vector<std::pair<std::string, std::string>> items{
      {"consent", plan.consent_version.empty() ? "consent" : "consent_version"},
      {"warm-up", "warm_up"},
      {"calibration", "calibration"},
      {"gravity-compensation", "gravity"},
      {"fixture-touch", "fixture"},
      {"placement", "placement"}};
  if (plan.sight == design::Sight::blindfold) {
    items.emplace_back("labels-learnt", "labels");
    items.emplace_back("blindfold", "blindfold");
  } else {
    items.emplace_back("curtain", "curtain");
  }
  if (!plan.masking.wanted) return items;
  items.emplace_back("headphones", "headphones");
  items.emplace_back("masking-level", "masking_level");
  return items;
}

std::vector<session::DaySheetItem> day_sheet(const design::Study& study,
                                             const LanguageTexts& texts) {
  const Words words = words_for(study, texts);
  std::vector<session::DaySheetItem> sheet;
  for (const auto& [code, key] : items_for(study.session)) {
    sheet.push_back({"no-" + code, filled(texts.day_sheet.at(key), words)});
  }
  int number = 0;
  for (const std::string& own : study.session.day_sheet) {
    sheet.push_back({"no-day-sheet-" + std::to_string(++number), own});
  }
  return sheet;
}

}  // namespace

session::SessionTexts session_texts(const design::Study& study) {
  const LanguageTexts& texts = texts_in(study.session.language);
  session::SessionTexts session;
  session.instructions = instructions(study, texts);
  if (study.session.handedness) session.handedness = handedness_inventory();
  session.closing = closing_questions(study.session);
  session.day_sheet = day_sheet(study, texts);
  return session;
}

}  // namespace touchtrial::app

#include "app/texts/language_texts.hpp"

#include "core/strict_json.hpp"
#include "protocols/design/protocol.hpp"

#include <array>
#include <span>

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

}  // namespace touchtrial::app

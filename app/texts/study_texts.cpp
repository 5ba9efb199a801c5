#include "app/texts/study_texts.hpp"

#include "app/texts/language_texts.hpp"
#include "protocols/design/protocol.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
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

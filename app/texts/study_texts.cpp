#include "app/texts/study_texts.hpp"

#include "app/windows/participant/words.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;
using Section = std::map<std::string, std::string>;

std::string seconds_text(double seconds, const std::string& language) {
  std::string text = fmt::format("{:g}", seconds);
  if (study::has_decimal_comma(language)) std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

std::optional<study::IntervalPlan> intervals_of(const study::Study& study) {
  return study.protocol->interval_plan(study);
}

Values values_for(const study::Study& study) {
  const std::string& language = study.session.language;
  Values values = {{"pictures", std::to_string(study.classes.size())},
                   {"limit", seconds_text(study.trials.explore_limit_s, language)},
                   {"confidence", std::to_string(study.session.confidence_levels)},
                   {"consent", study.session.consent_version}};
  if (const auto intervals = intervals_of(study)) {
    const Words words = words_of(study::texts_of(study.session));
    values.emplace_back("planes", std::to_string(intervals->count));
    values.emplace_back("seconds", seconds_text(intervals->seconds, language));
    values.emplace_back("question", title_of(words, intervals->question));
  }
  return values;
}

/// The part about practice: what is practised, and whether answers are told afterwards too.
/// \return empty if the study has no practice
std::string practice_part(const study::Study& study) {
  const auto intervals = intervals_of(study);
  if (!intervals) return study.trials.practice > 0 ? "practice" : "";
  if (intervals->practice_rounds == 0 || study.protocol->practice_trials(study, {}, 1).empty()) {
    return "";
  }
  return intervals->feedback ? "practice_intervals_feedback" : "practice_intervals";
}

std::string sight_part(const study::Study& study) {
  const std::string part = study.session.sight == study::Sight::blindfold ? "blindfold" : "curtain";
  return intervals_of(study) ? part + "_intervals" : part;
}

std::string time_part(const study::Study& study) {
  if (intervals_of(study)) return "time_intervals";
  return study.trials.on_timeout == study::OnTimeout::fade ? "time_fade" : "time_no_response";
}

/// The parts of the instructions on each page.
std::vector<std::vector<std::string>> pages_for(const study::Study& study) {
  std::vector<std::string> rules{time_part(study)};
  if (study.session.confidence_levels > 0) rules.push_back("confidence");
  if (study.session.masking.wanted) rules.push_back("masking");
  std::vector<std::vector<std::string>> pages{
      {"welcome"}, {study.protocol_name()}, {"hand"}, {sight_part(study)}, rules};
  if (const std::string practice = practice_part(study); !practice.empty()) {
    pages.push_back({practice});
    if (study.session.sight != study::Sight::blindfold) pages.back().push_back("practice_bars");
  }
  pages.push_back({"comfort"});
  return pages;
}

/// A part of the texts, for whoever wears a blindfold if that differs, or what the protocol says
/// itself.
std::string part_of(const study::Study& study, const Section& texts, const std::string& part) {
  const bool is_blindfold = study.session.sight == study::Sight::blindfold;
  auto found = is_blindfold ? texts.find(part + "_blindfold") : texts.end();
  if (found == texts.end()) found = texts.find(part);
  return found == texts.end() ? study.protocol->instruction() : found->second;
}

std::vector<std::string> instructions(const study::Study& study, const Section& texts) {
  const auto given = study.session.instructions.find(study.session.language);
  if (given != study.session.instructions.end() && !given->second.empty()) return given->second;
  const Values values = values_for(study);
  std::vector<std::string> pages;
  for (const std::vector<std::string>& parts : pages_for(study)) {
    std::string& page = pages.emplace_back();
    for (const std::string& part : parts) {
      if (!page.empty()) page += "\n\n";
      page += filled(part_of(study, texts, part), values);
    }
  }
  return pages;
}

/// Whose words questions have: the study's, in its language, and those of other languages.
struct Wording {
  const study::SessionPlan& plan;
  const study::Texts& texts;                  ///< the study's
  std::span<const std::string_view> further;  ///< languages
};

/// \param section  of the texts
/// \param key  of its text
/// \param options  keys of the options' texts; empty: a free answer
study::Question question(const Wording& wording, const char* section, std::string id,
                         const char* key, std::initializer_list<const char*> options) {
  const auto words_for = [&](const char* of) {
    study::Translated words;
    for (const std::string_view code : wording.further) {
      words[std::string(code)] = study::language_of(code).texts.at(section).at(of);
    }
    words[wording.plan.language] = wording.texts.at(section).at(of);
    return words;
  };
  study::Question asked;
  asked.id = std::move(id);
  asked.kind = options.size() == 0 ? study::QuestionKind::text : study::QuestionKind::choice;
  asked.text = words_for(key);
  for (const char* option : options) asked.options.push_back(words_for(option));
  return asked;
}

std::optional<study::Questionnaire> handedness_inventory(const Wording& wording) {
  if (!wording.plan.handedness) return std::nullopt;
  study::Questionnaire inventory{"handedness", {}};
  for (const char* item : {"writing", "throwing", "toothbrush", "spoon"}) {
    inventory.questions.push_back(
        question(wording, "handedness", item, item,
                 {"always_right", "usually_right", "both", "usually_left", "always_left"}));
  }
  inventory.questions.push_back(
      question(wording, "handedness", "pen-hand", "pen_hand", {"pen_right", "pen_left"}));
  inventory.questions.back().required = true;
  return inventory;
}

void join(std::vector<study::Question>& questions, const study::Question& given) {
  const auto same = std::ranges::find(questions, given.id, &study::Question::id);
  if (same == questions.end()) {
    questions.push_back(given);
  } else {
    *same = given;
  }
}

std::optional<study::Questionnaire> closing_questions(const Wording& wording) {
  study::Questionnaire closing{"closing", {}};
  if (wording.plan.closing) {
    closing.questions = {question(wording, "closing", "heard", "heard",
                                  {"heard_no", "heard_sometimes", "heard_often", "heard_helped"}),
                         question(wording, "closing", "strategy", "strategy", {}),
                         question(wording, "closing", "remarks", "remarks", {})};
  }
  for (const study::Question& given : wording.plan.closing_questions) {
    join(closing.questions, given);
  }
  if (closing.questions.empty()) return std::nullopt;
  return closing;
}

/// Each item's deviation code (for skipping it) and its key in a language file.
/// \param learns_names  whether participants with a blindfold answer with the textures' names
std::vector<std::pair<std::string, std::string>> items_for(const study::SessionPlan& plan,
                                                           bool learns_names) {
  std::vector<std::pair<std::string, std::string>> items{
      {"consent", plan.consent_version.empty() ? "consent" : "consent_version"},
      {"warm-up", "warm_up"},
      {"calibration", "calibration"},
      {"gravity-compensation", "gravity"},
      {"fixture-touch", "fixture"},
      {"placement", "placement"}};
  if (plan.sight == study::Sight::blindfold) {
    if (learns_names) items.emplace_back("labels-learnt", "labels");
    items.emplace_back("blindfold", "blindfold");
  } else {
    items.emplace_back("curtain", "curtain");
  }
  if (!plan.masking.wanted) return items;
  items.emplace_back("headphones", "headphones");
  items.emplace_back("masking-level", "masking_level");
  return items;
}

std::vector<session::DaySheetItem> day_sheet(const study::Study& study, const Section& texts) {
  const Values values = values_for(study);
  std::vector<session::DaySheetItem> sheet;
  for (const auto& [code, key] : items_for(study.session, !intervals_of(study))) {
    sheet.push_back({"no-" + code, filled(texts.at(key), values)});
  }
  int number = 0;
  for (const std::string& own : study.session.day_sheet) {
    sheet.push_back({"no-day-sheet-" + std::to_string(++number), own});
  }
  return sheet;
}

}  // namespace

session::SessionTexts session_texts(const study::Study& study) {
  const study::Texts texts = study::texts_of(study.session);
  session::SessionTexts session;
  session.instructions = instructions(study, texts.at("instructions"));
  const Wording wording{study.session, texts, study::language_codes()};
  session.handedness = handedness_inventory(wording);
  session.closing = closing_questions(wording);
  session.day_sheet = day_sheet(study, texts.at("day_sheet"));
  return session;
}

std::vector<study::Questionnaire> questionnaires_of(const study::Study& study) {
  const study::Texts texts = study::texts_of(study.session);
  const Wording wording{study.session, texts, {}};
  std::vector<study::Questionnaire> all;
  for (auto& one : {handedness_inventory(wording), closing_questions(wording)}) {
    if (one) all.push_back(*one);
  }
  return all;
}

}  // namespace touchtrial::app

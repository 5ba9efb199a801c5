#include "app/texts/study_texts.hpp"

#include "app/windows/participant/words.hpp"
#include "core/errors.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <variant>

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

/// The key suffix of texts for clocked planes and for ratings.
std::string suffix_of(const study::Ask& ask) {
  if (std::holds_alternative<study::InContact>(ask.exploring)) return "_intervals";
  return std::holds_alternative<study::Rate>(ask.question) ? "_rating" : "";
}

Values values_for(const study::Study& study) {
  const std::string& language = study.session.language;
  Values values = {{"pictures", std::to_string(study.classes.size())},
                   {"limit", seconds_text(study.trials.explore_limit_s, language)},
                   {"confidence", std::to_string(study.session.confidence_levels)},
                   {"consent", study.session.consent_version}};
  const study::Ask ask = study::ask_of(study);
  const Words words = words_of(study::texts_of(study.session));
  values.emplace_back("planes", std::to_string(ask.planes));
  values.emplace_back("question", title_of(words, ask.title()));
  if (const auto* const clocked = std::get_if<study::InContact>(&ask.exploring)) {
    values.emplace_back("seconds", seconds_text(clocked->seconds, language));
  }
  return values;
}

/// The parts about practice and feedback.
/// \return empty if the study has no practice
std::vector<std::string> practice_parts(const study::Study& study) {
  const study::Ask ask = study::ask_of(study);
  const study::Practice practice = study::practice_of(study);
  if (practice.trials.empty() || practice.rounds == 0) return {};
  std::vector<std::string> parts;
  const study::Trial& first = practice.trials.front();
  if (first.right) {
    parts.push_back("practice" + suffix_of(ask) + (ask.feedback ? "_feedback" : ""));
  } else {
    parts.emplace_back("practice_rating");
    const bool shows_ends = std::ranges::any_of(first.planes, &study::Plane::blank);
    if (shows_ends) parts.emplace_back("practice_ends");
  }
  if (study.session.sight != study::Sight::blindfold) parts.emplace_back("practice_bars");
  return parts;
}

std::string sight_part(const study::Study& study) {
  const std::string part = study.session.sight == study::Sight::blindfold ? "blindfold" : "curtain";
  return part + suffix_of(study::ask_of(study));
}

std::string time_part(const study::Study& study) {
  const study::Ask ask = study::ask_of(study);
  const std::string suffix = suffix_of(ask);
  if (std::holds_alternative<study::InContact>(ask.exploring)) return "time" + suffix;
  const bool fades = study.trials.on_timeout == study::OnTimeout::fade;
  return (fades ? "time_fade" : "time_no_response") + suffix;
}

/// The parts of the instructions on each page.
std::vector<std::vector<std::string>> pages_for(const study::Study& study) {
  std::vector<std::string> rules{time_part(study)};
  if (study.session.confidence_levels > 0) rules.push_back("confidence");
  if (study.session.masking.wanted) rules.push_back("masking");
  std::vector<std::vector<std::string>> pages{
      {"welcome"}, {study.protocol_name()}, {"hand"}, {sight_part(study)}, rules};
  if (const auto practice = practice_parts(study); !practice.empty()) pages.push_back(practice);
  pages.push_back({"comfort"});
  return pages;
}

/// A part of the texts, in the blindfold version if there is one.
/// \throws StudyError if the language has none
std::string part_of(const study::Study& study, const Section& texts, const std::string& part) {
  const bool is_blindfold = study.session.sight == study::Sight::blindfold;
  auto found = is_blindfold ? texts.find(part + "_blindfold") : texts.end();
  if (found == texts.end()) found = texts.find(part);
  if (found != texts.end()) return found->second;
  throw StudyError(one_line(fmt::format(
      "study {}: the texts of language {} have no instructions {}; write them in the study file's "
      "/session/instructions",
      study.name, study.session.language, part)));
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

/// The wording of questions: in the study's language, and in further languages.
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
  for (const auto& [code, key] : items_for(study.session, study::ask_of(study).has_pictures())) {
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

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

/// The suffix of the keys of texts for clocked planes and for ratings.
std::string suffix_of(const study::TrialQuestion& trial_question) {
  if (std::holds_alternative<study::TimedContact>(trial_question.exploring)) return "_intervals";
  return std::holds_alternative<study::RatingQuestion>(trial_question.question) ? "_rating" : "";
}

Values values_for(const study::Study& study) {
  const std::string& language = study.session.language;
  Values values = {{"pictures", std::to_string(study.classes.size())},
                   {"limit", seconds_text(study.trials.explore_limit_s, language)},
                   {"confidence", std::to_string(study.session.confidence_levels)},
                   {"consent", study.session.consent_version}};
  const study::TrialQuestion trial_question = study::trial_question_of(study);
  const Words words = words_of(study::texts_of(study.session));
  values.emplace_back("planes", std::to_string(trial_question.planes));
  values.emplace_back("question", title_of(words, trial_question.title()));
  if (const auto* const clocked = std::get_if<study::TimedContact>(&trial_question.exploring)) {
    values.emplace_back("seconds", seconds_text(clocked->seconds, language));
  }
  return values;
}

/// The parts about practice and feedback.
/// \return empty if the study has no practice
std::vector<std::string> practice_parts(const study::Study& study) {
  const study::TrialQuestion trial_question = study::trial_question_of(study);
  const study::Practice practice = study::practice_of(study);
  if (practice.trials.empty() || practice.rounds == 0) return {};
  std::vector<std::string> parts;
  const study::Trial& first = practice.trials.front();
  if (first.right) {
    parts.push_back("practice" + suffix_of(trial_question) +
                    (trial_question.feedback ? "_feedback" : ""));
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
  return part + suffix_of(study::trial_question_of(study));
}

std::string time_part(const study::Study& study) {
  const study::TrialQuestion trial_question = study::trial_question_of(study);
  const std::string suffix = suffix_of(trial_question);
  if (std::holds_alternative<study::TimedContact>(trial_question.exploring)) return "time" + suffix;
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
  auto text = is_blindfold ? texts.find(part + "_blindfold") : texts.end();
  if (text == texts.end()) text = texts.find(part);
  if (text != texts.end()) return text->second;
  throw StudyError(one_line(fmt::format(
      "study {}: the texts of language {} have no instructions {}; write them in the study file's "
      "/session/instructions",
      study.name, study.session.language, part)));
}

std::vector<std::string> instructions(const study::Study& study, const Section& texts) {
  const auto own_pages = study.session.instructions.find(study.session.language);
  const bool has_pages = own_pages != study.session.instructions.end();
  if (has_pages && !own_pages->second.empty()) return own_pages->second;
  const Values values = values_for(study);
  std::vector<std::string> pages;
  for (const std::vector<std::string>& parts : pages_for(study)) {
    std::string& page = pages.emplace_back();
    for (const std::string& part : parts) {
      if (!page.empty()) page += "\n\n";
      page += fill_placeholders(part_of(study, texts, part), values);
    }
  }
  return pages;
}

/// The sources of a question's wording: the study's language, and further languages.
struct Wording {
  const study::SessionPlan& plan;
  const study::Texts& texts;  ///< the study's
  std::span<const std::string_view> further_languages;
};

/// \param section  the section of the language file
/// \param key  the key of the question's text
/// \param options  keys of the options' texts; empty: a free answer
study::Question make_question(const Wording& wording, const char* section, std::string id,
                              const char* key, std::initializer_list<const char*> options) {
  const auto translations_of = [&](const char* text_key) {
    study::Translated words;
    for (const std::string_view code : wording.further_languages) {
      words[std::string(code)] = study::language_of(code).texts.at(section).at(text_key);
    }
    words[wording.plan.language] = wording.texts.at(section).at(text_key);
    return words;
  };
  study::Question result;
  result.id = std::move(id);
  result.kind = options.size() == 0 ? study::QuestionKind::text : study::QuestionKind::choice;
  result.text = translations_of(key);
  for (const char* option : options) result.options.push_back(translations_of(option));
  return result;
}

std::optional<study::Questionnaire> handedness_inventory(const Wording& wording) {
  if (!wording.plan.handedness) return std::nullopt;
  study::Questionnaire inventory{"handedness", {}};
  for (const char* item : {"writing", "throwing", "toothbrush", "spoon"}) {
    inventory.questions.push_back(
        make_question(wording, "handedness", item, item,
                      {"always_right", "usually_right", "both", "usually_left", "always_left"}));
  }
  inventory.questions.push_back(
      make_question(wording, "handedness", "pen-hand", "pen_hand", {"pen_right", "pen_left"}));
  inventory.questions.back().required = true;
  return inventory;
}

void add_or_replace(std::vector<study::Question>& questions, const study::Question& new_question) {
  const auto match = std::ranges::find(questions, new_question.id, &study::Question::id);
  if (match == questions.end()) {
    questions.push_back(new_question);
  } else {
    *match = new_question;
  }
}

std::optional<study::Questionnaire> closing_questions(const Wording& wording) {
  study::Questionnaire closing{"closing", {}};
  if (wording.plan.closing) {
    closing.questions = {
        make_question(wording, "closing", "heard", "heard",
                      {"heard_no", "heard_sometimes", "heard_often", "heard_helped"}),
        make_question(wording, "closing", "strategy", "strategy", {}),
        make_question(wording, "closing", "remarks", "remarks", {})};
  }
  for (const study::Question& closing_question : wording.plan.closing_questions) {
    add_or_replace(closing.questions, closing_question);
  }
  if (closing.questions.empty()) return std::nullopt;
  return closing;
}

/// Each item's deviation code (for skipping it) and its key in a language file.
/// \param learns_names  whether blindfolded participants answer with the textures' names
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
  for (const auto& [code, key] :
       items_for(study.session, study::trial_question_of(study).has_pictures())) {
    sheet.push_back({"no-" + code, fill_placeholders(texts.at(key), values)});
  }
  int number = 0;
  for (const std::string& item : study.session.day_sheet) {
    sheet.push_back({"no-day-sheet-" + std::to_string(++number), item});
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
  std::vector<study::Questionnaire> questionnaires;
  for (auto& questionnaire : {handedness_inventory(wording), closing_questions(wording)}) {
    if (questionnaire) questionnaires.push_back(*questionnaire);
  }
  return questionnaires;
}

}  // namespace touchtrial::app

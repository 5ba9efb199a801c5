#include "analysis/exports/demographics.hpp"

#include "analysis/exports/questionnaire_answers_json.hpp"
#include "analysis/sealed_sessions.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Changes ASCII letters only, in every locale.
std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// The text of an option in lower case, in English if the study has it in English.
std::optional<std::string> option_text(const design::Study& study, const std::string& question,
                                       int option) {
  for (const design::Question& one : study.session.closing_questions) {
    if (one.id != question || option < 0 || option >= static_cast<int>(one.options.size())) {
      continue;
    }
    const design::Translated& words = one.options[option];
    if (words.empty()) return std::nullopt;
    const auto english = words.find("en");
    return lower_case(english == words.end() ? words.begin()->second : english->second);
  }
  return std::nullopt;
}

void take_answers(const std::string& questionnaire, const QuestionnaireAnswers& answers,
                  const design::Study& study, Demographics& of) {
  if (questionnaire == "handedness") {
    if (const auto score = handedness_score(answers.choices)) of.handedness_score = score;
  }
  const auto age = answers.numbers.find("age");
  if (age != answers.numbers.end()) of.age_band = age_band(age->second);
  for (const char* id : {"sex", "gender"}) {
    const auto chosen = answers.choices.find(id);
    if (chosen == answers.choices.end()) continue;
    if (const auto text = option_text(study, id, chosen->second)) of.sex = text;
  }
}

}  // namespace

std::map<int, Demographics> demographics(const DatasetSource& source) {
  std::map<int, Demographics> all;
  if (source.key == nullptr) return all;
  const std::map<int, SecretKey> keys = participant_keys(source.store, *source.key);
  source.store.for_each(store::EventKind::questioned, [&](const store::Event& event) {
    const auto own = keys.find(event.session);
    if (own == keys.end()) return;
    take_answers(store::remark_from_json(event.body),
                 answers_from_json(opened_part(event, own->second)), source.key->study,
                 all[event.session]);
  });
  return all;
}

std::string age_band(double age) {
  if (!(age >= 18.0)) return "under 18";
  if (age < 20.0) return "18-19";
  if (age >= 70.0) return "70 or more";
  const int decade = static_cast<int>(std::floor(age / 10.0)) * 10;
  return fmt::format("{}-{}", decade, decade + 9);
}

std::optional<double> handedness_score(const std::map<std::string, int>& answers) {
  constexpr std::array<const char*, 4> kItems{"writing", "throwing", "toothbrush", "spoon"};
  double sum = 0.0;
  for (const char* item : kItems) {
    const auto answer = answers.find(item);
    if (answer == answers.end() || answer->second < 0 || answer->second > 4) return std::nullopt;
    sum += 100.0 - 50.0 * answer->second;
  }
  return sum / static_cast<double>(kItems.size());
}

std::string handedness_of(double score) {
  if (score > 60.0) return "right";
  return score < -60.0 ? "left" : "ambidextrous";
}

}  // namespace touchtrial::analysis

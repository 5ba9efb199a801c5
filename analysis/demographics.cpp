#include "analysis/demographics.hpp"

#include "analysis/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

/// Answers by the id of their question. Texts are left out, because they may name people.
struct QuestionnaireAnswers {
  std::map<std::string, int> choices;     ///< index of the option, or a whole number
  std::map<std::string, double> numbers;  ///< finite
};

bool fits_int(const nlohmann::json& value) {
  return value.is_number_integer() && value >= 0 && value <= std::numeric_limits<int>::max();
}

/// \throws StoreError if the text is not a JSON object
QuestionnaireAnswers answers_from_json(const std::string& text) {
  const nlohmann::json object = nlohmann::json::parse(text, nullptr, false);
  if (!object.is_object()) {
    throw StoreError("a questionnaire's answers are no JSON object; run `touchtrial verify`");
  }
  QuestionnaireAnswers answers;
  for (const auto& [id, value] : object.items()) {
    if (fits_int(value)) answers.choices[id] = value.get<int>();
    if (value.is_number()) answers.numbers[id] = value.get<double>();
  }
  return answers;
}

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

/// \param age  in years
std::string age_band(double age) {
  if (!(age >= 18.0)) return "under 18";
  if (age < 20.0) return "18-19";
  if (age >= 70.0) return "70 or more";
  const int decade = static_cast<int>(std::floor(age / 10.0)) * 10;
  return fmt::format("{}-{}", decade, decade + 9);
}

/// The laterality quotient: the mean over the inventory's four items, each 100 (always right), 50,
/// 0, -50 or -100. Source: Veale (2014), Laterality 19, 164-177.
/// \return nothing if an item has no answer
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

std::string handedness_of(double score) {
  if (score > 60.0) return "right";
  return score < -60.0 ? "left" : "ambidextrous";
}

std::map<int, Demographics> demographics_of(const store::StudyStore& store,
                                            const design::StudyKey& key) {
  std::map<int, Demographics> all;
  const std::map<int, SecretKey> keys = participant_keys(store, key);
  store.for_each(store::EventKind::questioned, [&](const store::Event& event) {
    const auto own = keys.find(event.session);
    if (own == keys.end()) return;
    take_answers(store::remark_from_json(event.body),
                 answers_from_json(whole_event(event, own->second).secret), key.study,
                 all[event.session]);
  });
  return all;
}

namespace {

/// \param counts  people by band, and under "" those who did not say
std::optional<Characteristic> shown(const std::string& name, std::map<std::string, int> counts) {
  Characteristic shown{name, {}, counts[""]};
  counts.erase("");
  if (counts.empty()) return std::nullopt;
  for (const auto& [band, people] : counts) {
    if (people >= kFewestOfBand) {
      shown.bands.push_back({band, people});
    } else {
      shown.others += people;
    }
  }
  // A few others would tell how many they are by what the bands leave of the whole.
  while (shown.others > 0 && shown.others < kFewestOfBand && !shown.bands.empty()) {
    const auto least = std::ranges::min_element(shown.bands, {}, &Band::people);
    shown.others += least->people;
    shown.bands.erase(least);
  }
  return shown;
}

}  // namespace

std::vector<Characteristic> in_bands(const std::vector<Demographics>& people) {
  std::map<std::string, int> ages;
  std::map<std::string, int> sexes;
  std::map<std::string, int> hands;
  for (const Demographics& one : people) {
    ++ages[one.age_band.value_or("")];
    ++sexes[one.sex.value_or("")];
    ++hands[one.handedness_score ? handedness_of(*one.handedness_score) : ""];
  }
  std::vector<Characteristic> all;
  for (auto& one : {shown("age", ages), shown("sex", sexes), shown("handedness", hands)}) {
    if (one) all.push_back(*one);
  }
  return all;
}

}  // namespace touchtrial::analysis

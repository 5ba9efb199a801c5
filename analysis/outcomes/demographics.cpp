#include "analysis/outcomes/demographics.hpp"

#include "analysis/outcomes/answers.hpp"

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

/// The text of an option in lower case, in English if available.
std::optional<std::string> option_text(const study::Study& study, const std::string& question,
                                       double option) {
  for (const study::Question& one : study.session.closing_questions) {
    if (one.id != question || option < 0.0 || option >= static_cast<double>(one.options.size())) {
      continue;
    }
    const std::string words = in_language(one.options[static_cast<std::size_t>(option)], "en");
    if (!words.empty()) return lower_case(words);
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
/// \param answers  one session's answers to the inventory, by item
/// \return nothing if an item has no answer
std::optional<double> handedness_score(const std::map<std::string, double>& answers) {
  constexpr std::array<const char*, 4> kItems{"writing", "throwing", "toothbrush", "spoon"};
  double sum = 0.0;
  for (const char* item : kItems) {
    const auto answer = answers.find(item);
    if (answer == answers.end() || answer->second < 0.0 || answer->second > 4.0)
      return std::nullopt;
    sum += 100.0 - 50.0 * answer->second;
  }
  return sum / static_cast<double>(kItems.size());
}

/// \param counts  people by band; "" are those who did not answer
std::optional<Characteristic> shown_bands(const std::string& name,
                                          std::map<std::string, int> counts) {
  Characteristic characteristic{name, {}, counts[""]};
  counts.erase("");
  if (counts.empty()) return std::nullopt;
  for (const auto& [band, people] : counts) characteristic.bands.push_back({band, people});
  characteristic.others = remove_small_bands(characteristic.bands, characteristic.others);
  return characteristic;
}

}  // namespace

void Demographics::update(const Demographics& later) {
  if (later.age_band) age_band = later.age_band;
  if (later.sex) sex = later.sex;
  if (later.handedness_score) handedness_score = later.handedness_score;
}

std::string handedness_of(double score) {
  if (score > 60.0) return "right";
  return score < -60.0 ? "left" : "ambidextrous";
}

std::map<int, Demographics> demographics_of(const std::vector<QuestionAnswer>& answers,
                                            const study::Study& study) {
  std::map<int, Demographics> all;
  std::map<int, std::map<std::string, double>> handedness_answers;
  for (const QuestionAnswer& answer : answers) {
    Demographics& session = all[answer.session];
    if (!answer.number) continue;
    if (answer.questionnaire == "handedness") {
      handedness_answers[answer.session][answer.question] = *answer.number;
    }
    if (answer.question == "age") session.age_band = age_band(*answer.number);
    if (answer.question != "sex" && answer.question != "gender") continue;
    if (const auto text = option_text(study, answer.question, *answer.number)) session.sex = text;
  }
  for (const auto& [number, items] : handedness_answers)
    all[number].handedness_score = handedness_score(items);
  return all;
}

int remove_small_bands(std::vector<Band>& bands, int others) {
  std::erase_if(bands, [&](const Band& band) {
    if (band.people >= kMinBandPeople) return false;
    others += band.people;
    return true;
  });
  while (others > 0 && others < kMinBandPeople && !bands.empty()) {
    const auto smallest_band = std::ranges::min_element(bands, {}, &Band::people);
    others += smallest_band->people;
    bands.erase(smallest_band);
  }
  return others;
}

std::vector<Characteristic> banded_characteristics(const std::vector<Demographics>& people) {
  std::map<std::string, int> ages;
  std::map<std::string, int> sexes;
  std::map<std::string, int> hands;
  for (const Demographics& one : people) {
    ++ages[one.age_band.value_or("")];
    ++sexes[one.sex.value_or("")];
    ++hands[one.handedness_score ? handedness_of(*one.handedness_score) : ""];
  }
  std::vector<Characteristic> all;
  for (auto& one :
       {shown_bands("age", ages), shown_bands("sex", sexes), shown_bands("handedness", hands)}) {
    if (one) all.push_back(*one);
  }
  return all;
}

}  // namespace touchtrial::analysis

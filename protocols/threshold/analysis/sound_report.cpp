#include "analysis/choices/people_report.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

CensoredMean mean_without(const StandardReport& standard, const std::vector<std::string>& names) {
  std::vector<PersonThreshold> other_people;
  for (std::size_t i = 0; i < standard.people.size(); ++i) {
    if (std::ranges::find(names, standard.people[i]) == names.end()) {
      other_people.push_back(standard.thresholds[i]);
    }
  }
  return mean_of(other_people);
}

}  // namespace

std::optional<SoundReport> sound_report(std::span<const choices::Person> people, double guess,
                                        std::span<const StandardReport> standards) {
  const std::optional<GuessingTests> answers =
      choices::test_against_guessing(people, guess, is_control_trial);
  if (!answers) return std::nullopt;
  SoundReport report{*answers,
                     choices::test_anyone_above_chance(*answers, guess),
                     choices::detectable_accuracy(*answers, guess),
                     {},
                     {}};
  report.hearers = choices::people_above_chance(*answers, report.global_null);
  if (report.hearers.empty()) return report;
  for (const StandardReport& standard : standards) {
    report.without_hearers.push_back(mean_without(standard, report.hearers));
  }
  return report;
}

std::string hearers_words(const SoundReport& control) {
  std::vector<std::string> people;
  for (const RightAnswers& person : control.people) {
    if (std::ranges::find(control.hearers, person.participant) == control.hearers.end()) continue;
    people.push_back(
        fmt::format("{} ({} of {})", person.participant, person.answers.correct, person.answers.n));
  }
  if (people.empty()) return "";
  return choices::individual_p_words(control.global_null) + ": " + listed(people, " and ");
}

}  // namespace touchtrial::analysis::threshold

#include "analysis/choices/people_report.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

CensoredMean mean_without(const StandardReport& standard, const std::vector<std::string>& names) {
  std::vector<PersonThreshold> others;
  for (std::size_t i = 0; i < standard.people.size(); ++i) {
    if (std::ranges::find(names, standard.people[i]) == names.end()) {
      others.push_back(standard.thresholds[i]);
    }
  }
  return mean_of(others);
}

}  // namespace

std::optional<SoundReport> sound_report(std::span<const choices::Person> people, double guess,
                                        std::span<const StandardReport> standards) {
  const std::optional<AgainstGuessing> answers =
      choices::against_guessing(people, guess, in_control);
  if (!answers) return std::nullopt;
  SoundReport report{*answers,
                     choices::test_anyone_above_chance(*answers, guess),
                     choices::detectable_in(*answers, guess),
                     {},
                     {}};
  report.hearers = choices::people_above_chance(*answers, report.anybody);
  if (report.hearers.empty()) return report;
  for (const StandardReport& one : standards) {
    report.without.push_back(mean_without(one, report.hearers));
  }
  return report;
}

std::string hearers_words(const SoundReport& control) {
  std::vector<std::string> people;
  for (const RightAnswers& one : control.people) {
    if (std::ranges::find(control.hearers, one.participant) == control.hearers.end()) continue;
    people.push_back(
        fmt::format("{} ({} of {})", one.participant, one.answers.correct, one.answers.n));
  }
  if (people.empty()) return "";
  return choices::alone_words(control.anybody) + ": " + listed(people, " and ");
}

}  // namespace touchtrial::analysis::threshold

#include "analysis/planning/people_spread.hpp"
#include "recovery/finding.hpp"
#include "recovery/population.hpp"

#include <cmath>

#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

constexpr int kClasses = 5;
constexpr int kRepeats = 5;
constexpr double kLapse = 0.02;

/// Five classes at a distance of one noise unit at ln noise 0.
std::vector<double> felt_at(double log_noise) {
  const Plane<double> p = answer_probabilities({}, std::exp(-log_noise));
  return {p.samples().begin(), p.samples().end()};
}

const planning::NoiseAnswers& noise_answers() {
  static const planning::NoiseAnswers answers = [] {
    planning::NoiseAnswers all{-4.0, 0.25, kClasses, {}};
    for (int i = 0; i <= 28; ++i) {
      all.answers.push_back({felt_at(all.min_log_noise + i * all.step)});
    }
    return all;
  }();
  return answers;
}

planning::CountedPerson answers_at(double log_noise, RandomStream& random) {
  Population person{.d_prime = std::exp(-log_noise), .lapse = kLapse, .repeats = kRepeats};
  planning::CountedPerson counted{0, std::vector<double>(kClasses * kClasses, 0.0)};
  for (const analysis::Choice& choice : answers_of(person, person.d_prime, random)) {
    counted.counts[choice.presented * kClasses + *choice.answered] += 1.0;
  }
  return counted;
}

/// The spread found in a study of 20 people with ln noise around -0.5.
planning::PeopleSpread found_in(double spread, RandomStream& random) {
  std::vector<planning::CountedPerson> people;
  for (int i = 0; i < 20; ++i) {
    people.push_back(answers_at(-0.5 + spread * random.normal(), random));
  }
  return planning::people_spread(noise_answers(), people, {.log_noise = -0.3, .lapse = 0.05})
      .value();
}

double holds(const planning::OpenInterval& interval, double truth) {
  return interval.lower.value_or(0.0) <= truth && truth <= interval.upper.value_or(9.0) ? 1.0 : 0.0;
}

void add_spread(double spread, int repetitions, std::vector<Finding>& findings) {
  const std::string who =
      fmt::format("20 participants, 25 trials, ln noise of SD {}, lapse {}", spread, kLapse);
  const auto averages = averages_of(repetitions, "spread" + who, [&](RandomStream& random) {
    const planning::PeopleSpread one = found_in(spread, random);
    return std::vector<double>{holds(one.interval, spread), one.equal_p <= 0.05 ? 1.0 : 0.0,
                               one.spread};
  });
  const Average& covered = averages[0];
  findings.push_back({"coverage", "spread of noise between people, profile", who, 0.95,
                      covered.mean, covered.standard_error, 0.92, spread > 0.0 ? 0.975 : 1.0,
                      spread > 0.0 ? "an approximation" : "at the end of the possible spreads"});
  if (spread == 0.0) {
    const Average& told = averages[1];
    findings.push_back({"type-I error", "people differ in their noise, likelihood ratio", who, 0.05,
                        told.mean, told.standard_error, 0.02, 0.06, "an approximation"});
    return;
  }
  const Average& mean = averages[2];
  findings.push_back({"recovered", "spread of noise between people", who, spread, mean.mean,
                      mean.standard_error, 0.9 * spread, 1.25 * spread,
                      "maximum likelihood, too large where answers tell little of it"});
}

/// Ten who feel nothing and ten who are nearly always right, taken for alike by their sums.
void add_halves(int repetitions, std::vector<Finding>& findings) {
  const Average found = average_of(repetitions, "halves", [](RandomStream& random) {
    std::vector<planning::CountedPerson> people;
    for (int i = 0; i < 20; ++i) people.push_back(answers_at(i % 2 == 0 ? -2.0 : 3.0, random));
    const auto one = planning::people_spread(noise_answers(), people, {.lapse = 0.4}).value();
    return one.equal_p <= 0.05 && one.lapse < 0.15 ? 1.0 : 0.0;
  });
  findings.push_back({"recovered", "half guess, half are right: found to differ, without lapses",
                      "20 participants, 25 trials", 1.0, found.mean, found.standard_error, 0.95,
                      1.0, "share of studies"});
}

}  // namespace

std::vector<Finding> people_findings(int repetitions) {
  std::vector<Finding> findings;
  for (const double spread : {0.0, 0.4, 0.8}) add_spread(spread, repetitions / 4, findings);
  add_halves(repetitions / 4, findings);
  return findings;
}

}  // namespace touchtrial::recovery

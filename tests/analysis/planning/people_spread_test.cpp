#include "analysis/planning/people_spread.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

constexpr int kClasses = 4;
constexpr int kTrials = 40;

/// Right in 1/4 of trials with much noise and always without; all errors are equally likely.
double right_at(double log_noise) {
  return 0.25 + 0.75 / (1.0 + std::exp(2.0 * log_noise));
}

planning::NoiseAnswers noise_answers() {
  planning::NoiseAnswers all{-4.0, 0.25, kClasses, {}};
  for (int k = 0; k <= 32; ++k) {
    const double right = right_at(all.min_log_noise + k * all.step);
    std::vector<double> cells;
    for (int i = 0; i < kClasses * kClasses; ++i) {
      cells.push_back(i / kClasses == i % kClasses ? right : (1.0 - right) / (kClasses - 1));
    }
    all.answers.push_back({cells});
  }
  return all;
}

planning::CountedPerson person_at(double log_noise, RandomStream& random, double lapse = 0.0) {
  planning::CountedPerson person{0, std::vector<double>(kClasses * kClasses, 0.0)};
  const double right = (1.0 - lapse) * right_at(log_noise) + lapse / kClasses;
  for (int trial = 0; trial < kTrials; ++trial) {
    const int shown = trial % kClasses;
    const int error = 1 + static_cast<int>(random.below(kClasses - 1));
    const int answer = random.uniform() < right ? shown : (shown + error) % kClasses;
    person.counts[shown * kClasses + answer] += 1.0;
  }
  return person;
}

std::vector<planning::CountedPerson> people_of(double spread, int count, double lapse = 0.0) {
  RandomStream random(5, "people of a spread");
  std::vector<planning::CountedPerson> people;
  for (int i = 0; i < count; ++i) {
    people.push_back(person_at(spread * random.normal(), random, lapse));
  }
  return people;
}

}  // namespace

TEST_CASE("the spread between people is found, and its interval holds it") {
  const auto found = planning::people_spread(noise_answers(), people_of(0.7, 100), {}).value();
  CHECK(found.spread == Approx(0.7).margin(0.2));
  CHECK(found.interval.lower.value() < 0.7);
  CHECK(found.interval.lower.value() > 0.3);
  CHECK(found.interval.upper.value() > 0.7);
  CHECK(found.log_noise == Approx(0.0).margin(0.3));
  CHECK(found.equal_p < 1e-6);
  CHECK(found.assumed_p == found.equal_p);
}

TEST_CASE("a given spread is tested too, and fixed numbers stay") {
  const auto people = people_of(0.7, 60, 0.1);
  const planning::SpreadStart start{.log_noise = 0.25,
                                    .lapse = 0.1,
                                    .spread = 0.7,
                                    .noise_is_free = false,
                                    .lapse_is_free = false};
  const auto found = planning::people_spread(noise_answers(), people, start).value();
  CHECK(found.log_noise == 0.25);
  CHECK(found.lapse == 0.1);
  CHECK(found.assumed_p > 0.05);
  CHECK(found.equal_p < 0.01);
  planning::SpreadStart too_much = start;
  too_much.spread = 2.5;
  CHECK(planning::people_spread(noise_answers(), people, too_much)->assumed_p < 0.01);
}

TEST_CASE("one person has no spread, and impossible arguments are refused") {
  CHECK_FALSE(planning::people_spread(noise_answers(), people_of(0.5, 1), {}).has_value());
  planning::NoiseAnswers few = noise_answers();
  few.answers.resize(3);
  CHECK_THROWS_AS(planning::people_spread(few, people_of(0.5, 3), {}), std::invalid_argument);
  CHECK_THROWS_AS(planning::people_spread(noise_answers(), people_of(0.5, 3), {.spread = -1.0}),
                  std::invalid_argument);
}

}  // namespace touchtrial

#include "protocols/simulation/condition.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <functional>

namespace touchtrial {
namespace {

constexpr int kManyPeople = 3000;

/// Checks numbers of many people against a normal distribution: within 4.5 standard errors.
void check_normal_numbers(const std::function<double(int)>& number_of, double mean, double sd) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 1; i <= kManyPeople; ++i) {
    const double value = number_of(i);
    sum += value;
    squares += (value - mean) * (value - mean);
  }
  CHECK(std::abs(sum / kManyPeople - mean) < 4.5 * sd / std::sqrt(kManyPeople));
  CHECK(std::abs(std::sqrt(squares / kManyPeople) - sd) < 4.5 * sd / std::sqrt(2.0 * kManyPeople));
}

TEST_CASE("a subject without changes is in the same condition in every trial") {
  const simulation::SubjectModel subject;
  simulation::Condition condition(subject, 1, 1, 3, 25);
  for (int nth = 1; nth <= 30; ++nth) {
    const simulation::ConditionEffects moment = condition.effects_on(nth, nth % 3);
    CHECK(moment.noise_factor == 1.0);
    CHECK(moment.lapse_log_odds == 0.0);
    CHECK_FALSE(moment.answer_leaning.has_value());
    CHECK_FALSE(moment.stimulus_leaning.has_value());
    CHECK(moment.thought == nullptr);
    condition.record_trial(1, 2);
    if (nth % 7 == 0) condition.rest(nth);
  }
}

TEST_CASE("noise begins higher by the factor and falls exponentially with presentations felt") {
  simulation::SubjectModel subject{.learning = {.factor = 1.8, .trials = 20.0}};
  simulation::Condition condition(subject, 1, 1);
  CHECK(condition.effects_on(1, 0).noise_factor == Approx(1.8));
  for (const int nth : {2, 11, 21, 61}) {
    CHECK(condition.effects_on(nth, 0).noise_factor ==
          Approx(std::pow(1.8, std::exp(-(nth - 1) / 20.0))));
  }
}

TEST_CASE("of what was learnt at earlier visits a share is forgotten at each visit's end") {
  simulation::SubjectModel subject{.learning = {.factor = 2.0, .trials = 40.0, .forgotten = 0.4}};
  const auto first_of = [&](int visit) {
    return simulation::Condition(subject, 1, 1, visit, 30).effects_on(1, 0).noise_factor;
  };
  CHECK(first_of(1) == Approx(2.0));
  CHECK(first_of(2) == Approx(std::pow(2.0, std::exp(-18.0 / 40.0))));
  CHECK(first_of(3) == Approx(std::pow(2.0, std::exp(-28.8 / 40.0))));
  subject.learning.forgotten = 1.0;
  CHECK(first_of(3) == Approx(2.0));
}

TEST_CASE("people learn differently much, and on average what the population's spread says") {
  simulation::SubjectModel subject{.learning = {.factor = 1.5, .trials = 25.0, .spread = 0.4}};
  const auto log_noise = [&](int number, int nth) {
    return std::log(simulation::Condition(subject, 9, number).effects_on(nth, 0).noise_factor);
  };
  check_normal_numbers([&](int i) { return std::log(log_noise(i, 1)); }, std::log(std::log(1.5)),
                       0.4);
  // A lognormal number's mean is exp(s^2 / 2) times its median.
  for (const int nth : {1, 10, 40}) {
    double sum = 0.0;
    for (int i = 1; i <= kManyPeople; ++i) sum += log_noise(i, nth);
    const double expected = std::log(1.5) * std::exp(0.08) * std::exp(-(nth - 1) / 25.0);
    CHECK(sum / kManyPeople == Approx(expected).epsilon(4.5 * 0.43 / std::sqrt(kManyPeople)));
  }
}

TEST_CASE("fatigue grows with the minutes of exploring, and a break takes its share away") {
  simulation::SubjectModel subject;
  subject.explore_s = 12.0;
  subject.fatigue = {.noise_per_min = 0.05, .lapse_per_min = 0.2, .recovered = 0.75};
  simulation::Condition condition(subject, 1, 1);
  // The slow reference counts every presentation.
  double minutes = 0.0;
  for (int nth = 1; nth <= 40; ++nth) {
    const simulation::ConditionEffects moment = condition.effects_on(nth, 0);
    CHECK(moment.noise_factor == Approx(std::exp(0.05 * minutes)));
    CHECK(moment.lapse_log_odds == Approx(0.2 * minutes).margin(1e-12));
    minutes += 0.2;
    if (nth % 15 != 0) continue;
    condition.rest(nth);
    minutes *= 0.25;
  }
  CHECK(minutes == Approx(0.25 * (0.25 * 3.0 + 3.0) + 2.0));
}

TEST_CASE("presentations that were not answered tire as well") {
  simulation::SubjectModel subject{.fatigue = {.noise_per_min = 0.1, .recovered = 0.5}};
  simulation::Condition every(subject, 1, 1);
  simulation::Condition some(subject, 1, 1);
  for (int nth = 1; nth <= 10; ++nth) {
    static_cast<void>(every.effects_on(nth, 0));
    if (nth % 3 == 0) static_cast<void>(some.effects_on(nth, 0));
  }
  every.rest(10);
  some.rest(10);
  CHECK(every.effects_on(11, 0).noise_factor == some.effects_on(11, 0).noise_factor);
}

TEST_CASE("each block and each visit of a person has noise of its own") {
  simulation::SubjectModel subject{.period_noise_spread = 0.3};
  const auto log_noise = [&](int number, int visit, int block, int nth) {
    return std::log(
        simulation::Condition(subject, 9, number, visit).effects_on(nth, block).noise_factor);
  };
  check_normal_numbers([&](int i) { return log_noise(i, 1, 0, 1); }, 0.0, 0.3);
  // Independent between blocks and between visits: variances add.
  const double both = 0.3 * std::sqrt(2.0);
  check_normal_numbers([&](int i) { return log_noise(i, 1, 1, 1) - log_noise(i, 1, 0, 1); }, 0.0,
                       both);
  check_normal_numbers([&](int i) { return log_noise(i, 2, 0, 1) - log_noise(i, 1, 0, 1); }, 0.0,
                       both);
  CHECK(log_noise(4, 1, 1, 1) == log_noise(4, 1, 1, 17));
  simulation::Condition condition(subject, 9, 4);
  const double first = condition.effects_on(1, 0).noise_factor;
  CHECK(condition.effects_on(2, 1).noise_factor != first);
  CHECK(condition.effects_on(3, 0).noise_factor == first);
}

TEST_CASE("the trial before leaves its leanings, and a plane without texture none") {
  simulation::SubjectModel subject{.serial = {.answer = 0.5, .stimulus = -0.25}};
  simulation::Condition condition(subject, 1, 1);
  CHECK_FALSE(condition.effects_on(1, 0).answer_leaning.has_value());
  condition.record_trial(3, 1);
  const simulation::ConditionEffects moment = condition.effects_on(2, 0);
  REQUIRE(moment.answer_leaning.has_value());
  REQUIRE(moment.stimulus_leaning.has_value());
  CHECK(moment.answer_leaning->position == 3);
  CHECK(moment.answer_leaning->log_odds == 0.5);
  CHECK(moment.stimulus_leaning->position == 1);
  CHECK(moment.stimulus_leaning->log_odds == -0.25);
  condition.record_trial(2, std::nullopt);
  CHECK_FALSE(condition.effects_on(3, 0).stimulus_leaning.has_value());
  CHECK(condition.effects_on(3, 0).answer_leaning->position == 2);
  condition.forget();
  CHECK_FALSE(condition.effects_on(4, 0).answer_leaning.has_value());
}

TEST_CASE("people differ in how they lean on the trial before") {
  simulation::SubjectModel subject;
  subject.serial = {.answer = 0.2, .answer_spread = 0.3, .stimulus = -0.1, .stimulus_spread = 0.15};
  const auto moment_of = [&](int number) {
    simulation::Condition condition(subject, 5, number);
    condition.record_trial(0, 1);
    return condition.effects_on(2, 0);
  };
  check_normal_numbers([&](int i) { return moment_of(i).answer_leaning->log_odds; }, 0.2, 0.3);
  check_normal_numbers([&](int i) { return moment_of(i).stimulus_leaning->log_odds; }, -0.1, 0.15);
}

TEST_CASE("one change does not shift the draws of another") {
  simulation::SubjectModel all{.learning = {.factor = 1.4, .spread = 0.3},
                               .period_noise_spread = 0.2,
                               .serial = {.answer = 0.2, .answer_spread = 0.3}};
  simulation::SubjectModel one = all;
  one.learning = {};
  one.serial = {};
  simulation::SubjectModel other = all;
  other.period_noise_spread = 0.0;
  const auto log_of = [](const simulation::SubjectModel& subject) {
    return std::log(simulation::Condition(subject, 2, 7).effects_on(3, 1).noise_factor);
  };
  CHECK(log_of(all) == Approx(log_of(one) + log_of(other)));
}

}  // namespace
}  // namespace touchtrial

#include "protocols/identification/planning/stated_people.hpp"

#include "core/errors.hpp"
#include "protocols/identification/planning/power_report.hpp"
#include "protocols/identification/planning/rehearsed_tiny_study.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <cmath>
#include <map>
#include <string>

namespace touchtrial {
namespace {

using namespace planning::identification;

PrimaryTest accuracy_test() {
  return {};
}

PrimaryTest difference_test() {
  PrimaryTest test;
  test.estimand = study::Estimand::difference;
  test.sides = analysis::Sides::two;
  return test;
}

/// Mean and spread of people's shares, and the spread that single trials alone would give.
struct Shares {
  double mean = 0.0;
  double variance = 0.0;
  double of_trials = 0.0;
};

Shares shares_of(const analysis::Outcomes& outcomes) {
  std::map<std::string, analysis::Proportion> people;
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    analysis::Proportion& person = people[trial.participant];
    ++person.n;
    if (trial.correct()) ++person.correct;
  }
  Shares shares;
  const auto n = static_cast<double>(people.size());
  for (const auto& [name, person] : people) shares.mean += *person.share() / n;
  for (const auto& [name, person] : people) {
    const double share = *person.share();
    shares.variance += (share - shares.mean) * (share - shares.mean) / (n - 1.0);
    shares.of_trials += share * (1.0 - share) / (person.n - 1.0) / n;
  }
  return shares;
}

TEST_CASE("stated people have the stated mean and spread, and guess under the null") {
  const RehearsedTinyStudy study;
  constexpr int kPeople = 4000;
  const double chance = 1.0 / static_cast<double>(study.tiny.key().study.classes.size());
  const double sd = GENERATE(0.0, 0.05, 0.2);
  const StatedRehearsal people(study.tiny.key().study, {0.6, sd}, study.test, kPeople);

  const Shares found = shares_of(people.outcomes(kPeople, Hypothesis::population, 7));
  CHECK(std::abs(found.mean - 0.6) < 5.0 * std::sqrt(found.variance / kPeople));
  // The variance of a normal sample errs by sqrt(2 / n); shares have lighter tails.
  const double error = 5.0 * found.variance * std::sqrt(2.0 / kPeople);
  CHECK(std::abs(found.variance - found.of_trials - sd * sd) < error);

  const Shares guessed = shares_of(people.outcomes(kPeople, Hypothesis::null, 8));
  CHECK(std::abs(guessed.mean - chance) < 5.0 * std::sqrt(guessed.variance / kPeople));
  CHECK(std::abs(guessed.variance - guessed.of_trials) <
        5.0 * guessed.variance * std::sqrt(2.0 / kPeople));
}

TEST_CASE("a study of stated people depends on its seed alone, and more people keep the first") {
  const RehearsedTinyStudy study;
  const StatedRehearsal people(study.tiny.key().study, {0.5, 0.1}, study.test, 6);
  const auto positions = [&](int n, std::uint64_t seed) {
    std::vector<int> all;
    for (const auto& trial : people.outcomes(n, Hypothesis::population, seed).trials) {
      all.push_back(*position_of(trial.row.answer));
    }
    return all;
  };
  const std::vector<int> few = positions(3, 1);
  std::vector<int> many = positions(6, 1);
  CHECK(few == positions(3, 1));
  CHECK(few != positions(3, 2));
  many.resize(few.size());
  CHECK(many == few);
}

TEST_CASE("power of the t test of stated people is that of its own formula") {
  const RehearsedTinyStudy study;
  planning::PowerPlan plan{.participants = {12}, .runs = 2000};
  PowerSetting setting;
  setting.fields = kNoFields;
  const double chance = 1.0 / static_cast<double>(study.tiny.key().study.classes.size());
  const StatedRehearsal people(study.tiny.key().study, {chance + 0.08, 0.1}, study.test, 12);
  const PowerReport report = planning::identification::make_power_report(
      planning::identification::make_runs(people, study.test, setting, plan, 2));
  const PowerRow& row = report.rows.front();

  // A person's share has the spread of people and that of their own trials.
  const auto trials =
      static_cast<double>(study::make_schedule(study.tiny.key().study,
                                               study.tiny.key().draw_of(1, study::Draws::rehearsal))
                              .trials.size());
  const double mean = chance + 0.08;
  const double variance = 0.01 + (mean * (1.0 - mean) - 0.01) / trials;
  const double shift = 0.08 / std::sqrt(variance / 12.0);
  // Student's t with 11 degrees of freedom at .05, one-sided, is 1.796; the noncentral t by its
  // normal approximation (Johnson, Kotz, Balakrishnan 1995, 31.25).
  const double t = 1.796;
  const double z = (t * (1.0 - 1.0 / 44.0) - shift) / std::sqrt(1.0 + t * t / 22.0);
  const double power = 0.5 * std::erfc(z / std::sqrt(2.0));
  INFO(power << " by the formula, " << row.estimated_power() << " by simulation");
  CHECK(std::abs(row.estimated_power() - power) < 0.05);
  CHECK(row.type_one.low < 0.06);
  CHECK_FALSE(report.setting.feels());
}

TEST_CASE("impossible people are refused with the range that is possible") {
  const auto refuse = [](const StatedPeople& people, const PrimaryTest& test, const char* places) {
    CHECK_THROWS_WITH(require_possible(people, test), names(places));
  };
  const double nan = std::nan("");
  refuse({1.2, 0.1}, accuracy_test(), "0 1");
  refuse({nan, 0.1}, accuracy_test(), "0 1");
  refuse({0.3, 0.5}, accuracy_test(), "0.4583");
  refuse({0.3, -0.1}, accuracy_test(), "0.4583");
  refuse({0.3, nan}, accuracy_test(), "0.4583");
  refuse({0.3, 0.1, 0.5}, accuracy_test(), "--accuracy");
  refuse({0.1, 0.1}, difference_test(), "--accuracy 0.5");
  refuse({0.1, 0.1, 1.0}, difference_test(), "0 1");
  refuse({0.5, 0.1, 0.9}, difference_test(), "-0.2 0.2");
  refuse({0.19, 0.1, 0.9}, difference_test(), "--sd-between");
  PrimaryTest margin = difference_test();
  margin.margin = 0.3;
  refuse({0.0, 0.1, 0.9}, margin, "--mean -0.3");
  CHECK_NOTHROW(require_possible({0.1, 0.1, 0.6}, difference_test()));
  CHECK_NOTHROW(require_possible({1.0, 0.0}, accuracy_test()));
}

}  // namespace
}  // namespace touchtrial

#include "protocols/identification/planning/power_report.hpp"
#include "protocols/identification/planning/rehearsed_tiny_study.hpp"
#include "support/catch.hpp"

#include <cmath>

namespace touchtrial {
namespace {

planning::identification::PowerReport report_of(const RehearsedTinyStudy& study,
                                                std::vector<int> sizes, int runs) {
  const planning::identification::PrecomputedPerception bank = study.bank(30, 4);
  planning::PowerPlan plan{.participants = std::move(sizes), .runs = runs};
  return planning::identification::make_power_report(planning::identification::make_runs(
      study.planned(bank, plan.participants.back()), study.test, {}, plan, 2));
}

/// The type-I error must lie within four Monte-Carlo standard errors of the attainable error.
void check_type_one(const planning::identification::PowerReport& report) {
  for (const planning::identification::PowerRow& row : report.rows) {
    const double error = *row.false_alarms.share();
    const double n = row.false_alarms.n;
    CHECK(row.attainable > 0.0);
    CHECK(row.attainable <= 0.05);
    const double standard_error = std::sqrt(row.attainable * (1.0 - row.attainable) / n);
    CHECK(std::abs(error - row.attainable) < 4.0 * standard_error);
  }
}

TinyStudyOptions briefly(const char* trials) {
  return {.side_px = 60, .trials = trials};
}

/// A subject who feels hardly anything, so that power grows with the number of participants.
simulation::SubjectModel dull_subject() {
  simulation::SubjectModel subject = hasty_subject();
  subject.feature_noise = 6.0;
  return subject;
}

TEST_CASE("the test against chance has its type-I error, and more power with more participants") {
  const RehearsedTinyStudy study(briefly(R"({"repeats":3})"), dull_subject());
  const planning::identification::PowerReport report = report_of(study, {3, 24}, 500);
  check_type_one(report);
  const planning::identification::PowerRow& few = report.rows[0];
  const planning::identification::PowerRow& many = report.rows[1];
  INFO(planning::identification::power_text(report));
  CHECK(few.power.low < many.power.low);
  CHECK(*many.significant.share() > *few.significant.share() + 0.1);
  // With eight times the participants, the interval is a third as wide, or narrower by Student's t.
  CHECK(many.width.mean < 0.5 * few.width.mean);
}

TEST_CASE(
    "two methods that feel alike differ as often as the test's level says, with bias and lapses") {
  TinyStudyOptions options = briefly(R"({"repeats":2,"blocks":"mixed"})");
  options.comparison = true;
  check_type_one(report_of(RehearsedTinyStudy(options), {8, 14}, 500));
}

TEST_CASE("two methods that feel alike differ as seldom in blocks by method, whoever learns") {
  TinyStudyOptions options = briefly(R"({"repeats":2})");
  options.comparison = true;
  check_type_one(report_of(RehearsedTinyStudy(options), {8, 14}, 500));
  simulation::SubjectModel learner = hasty_subject();
  learner.learning = {.factor = 4.0, .trials = 20.0, .forgotten = 0.0, .spread = 0.0};
  check_type_one(report_of(RehearsedTinyStudy(options, learner), {14}, 500));
}

TEST_CASE("the test holds its type-I error with orders that the study's rule draws") {
  const RehearsedTinyStudy study(briefly(R"({"repeats":2,"max_run":1,"catch":1})"));
  check_type_one(report_of(study, {4}, 200));
}

}  // namespace
}  // namespace touchtrial

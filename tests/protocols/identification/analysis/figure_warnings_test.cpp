#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using namespace analysis::identification;

StudyReport report_of(FakeStudy& study) {
  study.close_and_unblind();
  return make_report(analysis::load_outcomes(study.store(), study.key()));
}

/// One participant with these answers.
StudyReport report_of_one(const FakeAnswers& answers, const FakeOptions& options = {}) {
  FakeStudy study(options);
  study.add({.participant = "P01", .answers = answers});
  return report_of(study);
}

int warnings_with(const StudyReport& report, const std::string& part) {
  return static_cast<int>(std::ranges::count_if(
      report.warnings, [&](const std::string& warning) { return contains(warning, part); }));
}

/// Takes the first two classes for each other.
std::optional<int> swapping(const study::Trial& shown) {
  const int felt = shown.field().class_index;
  return felt < 2 ? 1 - felt : felt;
}

}  // namespace

TEST_CASE(
    "What one participant's answers and the study's order hide is reported, and nothing else") {
  const StudyReport swapped = report_of_one(swapping);
  const StudyReport right = report_of_one(FakeStudy::always_right());
  const StudyReport without_cloth = report_of_one(FakeStudy::confusing(1, 0));
  const StudyReport drawn = report_of_one(swapping, {.trials = R"({"order": "uniform"})"});
  CHECK(warnings_with(swapped, "labels may have been swapped by P01 (33.3%, but 100.0%") == 1);
  CHECK(warnings_with(right, "swapped") == 0);
  CHECK(warnings_with(without_cloth, "cloth was never answered") == 1);
  CHECK_FALSE(without_cloth.methods[0].choice.has_value());
  CHECK(warnings_with(right, "never answered") == 0);
  CHECK(warnings_with(right, "d' has a lower bound alone") == 1);
  CHECK(warnings_with(swapped, "lower bound") == 0);
  CHECK(warnings_with(swapped, "bark, cloth, straw rests on 5 trials or fewer") == 1);
  CHECK(warnings_with(drawn, "Classes were drawn independently") == 1);
  CHECK(warnings_with(swapped, "Classes were drawn independently") == 0);
}

TEST_CASE("Classes of more than five pooled trials are not warned of") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1, .answers = swapping});
  study.add({.participant = "P02", .enrolment = 2, .answers = swapping});
  CHECK(warnings_with(report_of(study), "trials or fewer") == 0);
}

TEST_CASE("The headline is repeated without invalid trials") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1});
  study.add({.participant = "P02", .enrolment = 2, .answers = swapping, .valid = false});
  const StudyReport report = report_of(study);
  CHECK(warnings_with(report,
                      "adaptive: without 12 trials not valid by the study's rule the mean over "
                      "participants is 100.0% in place of 66.7%.") == 1);
}

TEST_CASE("A Monte Carlo p that cannot be smaller is reported") {
  const StudyReport report =
      report_of_one(FakeStudy::always_right(), {.trials = R"({"max_run": 2, "repeats": 6})"});
  REQUIRE(report.methods[0].chance.has_value());
  CHECK_FALSE(report.methods[0].chance->exact);
  CHECK(warnings_with(report, "the chance test's p = 0.0001 is the smallest") == 1);
}

TEST_CASE("One who swaps labels among many is suspected, and guessers are not") {
  FakeStudy study({.trials = R"({"repeats": 8})"});
  study.add({.participant = "P01", .enrolment = 1, .answers = swapping});
  for (int i = 2; i <= 12; ++i) {
    // Answers that have nothing to do with what is presented.
    study.add({.participant = "P" + std::to_string(i),
               .enrolment = i,
               .answers = [i](const study::Trial& shown) {
                 return std::optional((shown.place.trial * 7 + i) % 3);
               }});
  }
  const StudyReport report = report_of(study);
  CHECK(warnings_with(report,
                      "labels may have been swapped by P01 (33.3%, but 100.0% under the "
                      "best exchange); accuracy") == 1);
  CHECK(warnings_with(report, "with a probability of 0.05 at most") == 1);
  const auto& people = report.methods[0].per_participant;
  CHECK(people[0].swap_p == Approx(1.0 / 65536.0).epsilon(1e-9));
  CHECK(people[0].swap_adjusted == Approx(12.0 / 65536.0).epsilon(1e-9));
}

}  // namespace touchtrial

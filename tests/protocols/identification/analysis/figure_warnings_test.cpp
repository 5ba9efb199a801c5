#include "analysis/fake_study.hpp"
#include "analysis/text_matching.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

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

int warnings_with(const StudyReport& report, const std::string& places) {
  return static_cast<int>(std::ranges::count_if(
      report.warnings, [&](const std::string& warning) { return names(warning, places); }));
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
  CHECK(warnings_with(swapped, "P01 33.3% 100.0%") == 1);
  CHECK(warnings_with(right, "P01 33.3%") == 0);
  CHECK(warnings_with(without_cloth, "cloth") > warnings_with(right, "cloth"));
  CHECK_FALSE(without_cloth.methods[0].choice.has_value());
  CHECK(warnings_with(right, "d'") == 1);
  CHECK(warnings_with(swapped, "d'") == 0);
  CHECK(warnings_with(swapped, "bark cloth straw 5") == 1);
  CHECK(drawn.warnings != swapped.warnings);
}

TEST_CASE("Classes of more than five pooled trials are not warned of") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1, .answers = swapping});
  study.add({.participant = "P02", .enrolment = 2, .answers = swapping});
  CHECK(warnings_with(report_of(study), "bark cloth straw 5") == 0);
}

TEST_CASE("The headline is repeated without invalid trials") {
  FakeStudy study(study::identification::classification());
  study.add({.participant = "P01", .enrolment = 1});
  study.add({.participant = "P02", .enrolment = 2, .answers = swapping, .valid = false});
  const StudyReport report = report_of(study);
  CHECK(warnings_with(report, "adaptive 12 100.0% 66.7%") == 1);
}

TEST_CASE("A Monte Carlo p that cannot be smaller is reported") {
  const StudyReport report =
      report_of_one(FakeStudy::always_right(), {.trials = R"({"max_run": 2, "repeats": 6})"});
  REQUIRE(report.methods[0].chance.has_value());
  CHECK_FALSE(report.methods[0].chance->exact);
  CHECK(warnings_with(report, "0.0001") == 1);
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
  CHECK(warnings_with(report, "P01 33.3% 100.0%") == 1);
  CHECK(warnings_with(report, "P01 0.05") == 1);
  const auto& people = report.methods[0].per_participant;
  CHECK(people[0].swap_p == Approx(1.0 / 65536.0).epsilon(1e-9));
  CHECK(people[0].swap_p_adjusted == Approx(12.0 / 65536.0).epsilon(1e-9));
}

}  // namespace touchtrial

#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_csv.hpp"
#include "analysis/fake_study.hpp"
#include "analysis/report/report.hpp"
#include "support/catch.hpp"

#include <chrono>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

/// What the report of a study says, and what it says of its CSV files.
void check_round_trip(FakeStudy& study) {
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  const std::filesystem::path out = study.folder() / "out";
  export_csv(study.store(), outcomes, out);
  Outcomes read_back = outcomes_from_csv(out);
  REQUIRE(read_back.trials.size() == outcomes.trials.size());
  for (std::size_t i = 0; i < outcomes.trials.size(); ++i) {
    CHECK(read_back.trials[i].row == outcomes.trials[i].row);
    CHECK(read_back.trials[i].measures == outcomes.trials[i].measures);
  }
  REQUIRE(read_back.sessions.size() == outcomes.sessions.size());
  for (std::size_t i = 0; i < outcomes.sessions.size(); ++i) {
    CHECK(read_back.sessions[i].row == outcomes.sessions[i].row);
  }
  // How it was collected is no figure, and in other files than these.
  read_back.collection = outcomes.collection;
  CHECK(report_json(make_report(read_back)) == report_json(make_report(outcomes)));
}

/// Wrong now and then, in a way that depends on who answers.
FakeAnswers imperfect(int participant) {
  return [=](const Presentation& shown) -> std::optional<int> {
    if ((shown.trial + participant) % 7 == 0) return std::nullopt;
    if ((shown.trial * participant) % 3 == 0) return (shown.stimulus.class_index + 1) % 3;
    return shown.stimulus.class_index;
  };
}

void fill(FakeStudy& study) {
  for (int i = 1; i <= 5; ++i) {
    study.add({.participant = "P0" + std::to_string(i),
               .enrolment = i,
               .answers = imperfect(i),
               .valid = i != 2,
               .within_limits = i != 3,
               .interrupt_trial = i == 4 ? 3 : 0});
  }
  study.add({.participant = "P06",
             .enrolment = 6,
             .answers = imperfect(6),
             .complete = false,
             .stop_after = 4});
}

}  // namespace

TEST_CASE("A classification study reports the same from its CSV files, to the last digit") {
  FakeStudy study(Protocol::classification, {.label = "bark, \"old\" (two, three)"});
  fill(study);
  study.store().exclude(1, milliseconds(900), "fell asleep, \"twice\"");
  study.close_and_unblind();
  check_round_trip(study);
}

TEST_CASE("A comparison of methods reports the same from its CSV files, to the last digit") {
  FakeStudy study(Protocol::comparison);
  fill(study);
  study.store().withdraw(2, milliseconds(900), "asked to");
  study.close_and_unblind();
  check_round_trip(study);
}

TEST_CASE("A study with lead-ins and catch trials reports the same from its CSV files") {
  FakeStudy study(Protocol::classification, {.trials = R"({"lead_in": 1, "catch": 2})"});
  fill(study);
  study.close_and_unblind();
  check_round_trip(study);
  CHECK(rows_of(study.folder() / "out" / "unscored_trials.csv").size() == 5 * 3 + 1);
}

TEST_CASE("An interim look reports the same from its CSV files") {
  FakeStudy study(Protocol::classification);
  fill(study);
  study.store().unblind(milliseconds(1000), "safety", true);
  study.add({.participant = "P07", .enrolment = 7, .answers = imperfect(7)});
  check_round_trip(study);
}

TEST_CASE("Participants who are no simulation are not stamped, and report the same") {
  FakeStudy study(Protocol::classification, {.simulated = false});
  fill(study);
  study.close_and_unblind();
  check_round_trip(study);
  for (const CsvRow& row : rows_of(study.folder() / "out" / "trials.csv")) {
    CHECK(row.at("simulated") == "0");
  }
}

}  // namespace touchtrial

#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/fake_study.hpp"
#include "support/catch.hpp"

#include <chrono>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

const record::InterruptionDetail kDetail{.safety_fault = "device",
                                         .device_fault = "link_lost",
                                         .ticks = 2,
                                         .flight = "tick,time_s\r\n0,0\r\n1,0.001\r\n"};

FakeSession of_somebody(const std::string& participant, int enrolment) {
  return {.participant = participant,
          .enrolment = enrolment,
          .answers = FakeStudy::always_right(),
          .before_trials = [](record::SessionRecorder& recorder) {
            recorder.add(milliseconds(50), record::EventKind::noted,
                         record::RemarkBody{.text = "came late"});
            recorder.presented(milliseconds(100), 1, 0);
            recorder.interrupted(milliseconds(1500), 1, "device lost", kDetail);
          }};
}

std::vector<std::filesystem::path> exported(FakeStudy& study) {
  return analysis::export_events(study.store(), study.key(),
                                 analysis::load_outcomes(study.store(), study.key()),
                                 study.folder() / "out");
}

}  // namespace

TEST_CASE("Exported events have remarks, faults by name, and flight records as they were") {
  FakeStudy study({.simulated = false});
  study.add(of_somebody("P01", 1));
  study.add({.participant = "P02", .enrolment = 2, .interrupt_trial = 3});
  study.store().note(2, milliseconds(7), "", "wrote a letter");
  study.close_and_unblind();
  const auto files = exported(study);
  REQUIRE(files.size() == 2);
  const std::vector<CsvRow> rows = rows_of(files[0]);
  REQUIRE(rows.size() == 4);
  check_row(
      rows[0],
      "kind=participant-noted, participant=P02, session=2, at_s=, at_utc=1970-01-01T00:00:00Z");
  CHECK(rows[0].at("body") == R"({"code":"","session":2,"text":"wrote a letter"})");
  CHECK(rows[1].at("kind") == "noted");
  CHECK(rows[1].at("body") == R"({"text":"came late"})");
  CHECK(rows[1].at("flight").empty());
  check_row(rows[2], "kind=interrupted, participant=P01, event=3, at_s=1.5");
  CHECK(
      rows[2].at("body") ==
      R"({"device_fault":"link_lost","largest_force_n":0.0,"reason":"device lost","safety_fault":"device","trial":1})");
  check_row(rows[2],
            "safety_fault=device, device_fault=link_lost, flight=flight_1_3.csv, simulated=0");
  CHECK(text_of_file(files[1]) == "tick,time_s\n0,0\n1,0.001\n");
  CHECK(rows[3].at("body") == R"({"reason":"comfort stop","trial":3})");
  CHECK(rows[3].at("safety_fault").empty());
}

TEST_CASE("Exported events leave out erased participants, and those that an interim look hides") {
  FakeStudy study(study::identification::classification());
  study.add(of_somebody("P01", 1));
  study.add(of_somebody("P02", 2));
  study.store().note(2, milliseconds(4), "", "asked how long it takes");
  study.store().withdraw(2, milliseconds(5), "asked to");
  study.store().unblind(milliseconds(6), "harm is feared", true);
  study.add(of_somebody("P03", 3));
  const auto files = exported(study);
  REQUIRE(files.size() == 2);
  CHECK(files[1].filename() == "SIMULATED_flight_1_3.csv");
  for (const CsvRow& row : rows_of(files[0])) CHECK(row.at("participant") == "P01");
  CHECK(rows_of(files[0]).size() == 2);
}

}  // namespace touchtrial

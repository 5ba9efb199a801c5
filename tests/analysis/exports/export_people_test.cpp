#include "analysis/exports/export_people.hpp"

#include "analysis/exports/csv_reading.hpp"
#include "analysis/fake_study.hpp"
#include "core/errors.hpp"
#include "support/catch.hpp"

#include <chrono>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

const record::InterruptionDetail kOverspeed{
    .safety_fault = "overspeed", .device_fault = "none", .ticks = 1, .flight = "tick\r\n0\r\n"};

/// Somebody whose session had a fault, a deviation and a stop.
FakeSession with_a_cramp(const std::string& participant, int enrolment) {
  return {.participant = participant,
          .enrolment = enrolment,
          .complete = false,
          .stop_after = 0,
          .before_trials = [](record::SessionRecorder& recorder) {
            recorder.add(milliseconds(10), record::EventKind::deviated,
                         record::DeviationBody{.code = "no-curtain", .text = "in the wash"});
            recorder.add(milliseconds(50), record::EventKind::noted,
                         record::RemarkBody{.text = "tall"});
            recorder.presented(milliseconds(100), 1, 0);
            recorder.interrupted(milliseconds(1500), 1, "device fault", kOverspeed);
            recorder.add(milliseconds(2500), record::EventKind::stopped,
                         record::StopBody{.code = "", .text = "a cramp"});
          }};
}

std::string all_text(const std::vector<std::filesystem::path>& files) {
  std::string text;
  for (const std::filesystem::path& file : files) text += text_of_file(file);
  return text;
}

bool says(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

/// One who stopped and stays, one who stopped and is erased, one who is complete.
void add_three(FakeStudy& study) {
  study.add(with_a_cramp("P01", 1));
  study.add(with_a_cramp("P02", 2));
  study.add({.participant = "P03", .enrolment = 3});
  study.store().note(2, milliseconds(20), "too-hot", "30 degrees");
  study.store().note(2, milliseconds(21), "", "wrote a letter");
  study.store().exclude(3, milliseconds(22), "asleep");
  study.store().withdraw(2, milliseconds(30), "asked to");
}

}  // namespace

TEST_CASE("The safety record has everybody's stops, faults and deviations, and no outcome") {
  FakeStudy study({.simulated = false});
  add_three(study);
  const auto files = analysis::export_safety(study.store(), nullptr, study.folder() / "codes");
  REQUIRE(files.size() == 2);
  const std::vector<CsvRow> sessions = rows_of(files[0]);
  REQUIRE(sessions.size() == 3);
  check_row(sessions[1], "participant=P02, erased=1, interruptions=1, stops=1, deviations=2");
  CHECK(sessions[2].at("stops") == "0");
  const std::vector<CsvRow> events = rows_of(files[1]);
  REQUIRE(events.size() == 3 + 3 + 3);  // in two sessions, and on the file's chain
  check_row(events[0], "kind=deviated, code=no-curtain");
  check_row(events[1], "kind=interrupted, trial=1, code=device fault, safety_fault=overspeed");
  CHECK(events[2].at("kind") == "stopped");
  for (const CsvRow& event : events) {
    check_row(event, "text=, at_s=");
  }
  const std::string text = all_text(files);
  for (const char* const words : {"wash", "cramp", "30 degrees", "asleep", "letter", "tall"}) {
    CHECK_FALSE(says(text, words));
  }
}

TEST_CASE("With the key the safety record has what was typed, also of erased people") {
  FakeStudy study({.simulated = false});
  add_three(study);
  const auto files = analysis::export_safety(study.store(), &study.key(), study.folder() / "texts");
  const std::string text = all_text(files);
  for (const char* const words : {"wash", "cramp", "30 degrees", "asleep", "asked to"}) {
    CHECK(says(text, words));
  }
  // Remarks, answers and flight records belong to the participant's key.
  for (const char* const words : {"letter", "tall", "response", "position", "bark"}) {
    CHECK_FALSE(says(text, words));
  }
  const std::vector<CsvRow> events = rows_of(files[1]);
  check_row(events[2], "text=a cramp, at_s=2.5");
  check_row(events[5], "participant=P02, text=a cramp");
  CHECK(events[1].at("at_s").empty());

  constexpr auto kLater = std::chrono::hours(24 * 366 * 11);
  study.store().withdraw(2, kLater, "", record::Retention::nothing);
  const std::string after =
      all_text(analysis::export_safety(study.store(), &study.key(), study.folder() / "less"));
  CHECK_FALSE(says(after, "30 degrees"));
  CHECK_FALSE(says(after, "asked to"));
  CHECK(says(after, "too-hot"));
  CHECK(says(after, "asleep"));
}

TEST_CASE("The safety record says where the largest force of an open session comes from") {
  FakeStudy study({.simulated = false});
  const auto felt = [](const study::Trial& shown) {
    record::Trace trace;
    trace.samples.assign(20, {{0.0, 0.0, -0.5}, {0.0, 0.0, 1.04 + 0.5 * (shown.place.trial % 2)}});
    return trace;
  };
  const auto add = [&](const std::string& participant, int enrolment, int presentations) {
    study.add({.participant = participant,
               .enrolment = enrolment,
               .stop_after = presentations,
               .traces = felt,
               .ends = false});
  };
  add("P01", 1, 2);
  add("P02", 2, 2);
  add("P03", 3, 0);
  study.add(with_a_cramp("P04", 4));
  study.store().withdraw(2, milliseconds(30), "asked to");
  const auto forces = [&](const study::StudyKey* key) {
    std::vector<std::string> found;
    const auto files = analysis::export_safety(study.store(), key, study.folder() / "safety");
    for (const CsvRow& row : rows_of(files[0])) {
      found.push_back(row.at("largest_force_of") + ":" + row.at("largest_force_n"));
    }
    return found;
  };
  CHECK(forces(nullptr) ==
        std::vector<std::string>{"not-known:", "not-known:", "not-known:", "not-known:"});
  CHECK(forces(&study.key()) ==
        std::vector<std::string>{"so-far:1.5", "not-known:", "none:", "none:"});
}

TEST_CASE("Exports of what people said of themselves are their reader's alone") {
  FakeStudy study({.simulated = false});
  add_three(study);
  const auto is_private = [](const std::filesystem::path& file) {
    const auto others = std::filesystem::perms::group_all | std::filesystem::perms::others_all;
    return (std::filesystem::status(file).permissions() & others) == std::filesystem::perms::none;
  };
  record::PersonalRecord person;
  person.participant = "P01";
  person.contact = "somebody@example.org";
  const auto folder = study.folder() / "one";
  const auto files = analysis::export_participant({study.store()}, "P01", {person}, folder);
  for (const auto& file : files) CHECK(is_private(file) == (file.filename() == "P01_personal.csv"));
  const auto export_with = [&](const study::StudyKey* key) {
    return analysis::export_safety(study.store(), key, study.folder() / "safety");
  };
  CHECK_FALSE(is_private(export_with(nullptr)[1]));
  CHECK(is_private(export_with(&study.key())[1]));
}

TEST_CASE("A participant's export has that participant alone, and outcomes only where given") {
  FakeStudy study({.simulated = false});
  study.add(talkative("P-1", 1, R"({"strategy":"by the grain"})"));
  study.add({.participant = "P2", .enrolment = 2, .answers = FakeStudy::confusing(0, 1)});
  study.store().note(1, milliseconds(20), "", "wrote a letter");
  record::PersonalRecord person{
      .participant = "P-1", .consent_version = "3", .contact = "somebody@example.org"};
  const auto folder = study.folder() / "one";
  record::PersonalRecord again = person;
  again.consent_version = "4";
  again.contact = "";
  const auto clear = analysis::export_participant({study.store()}, "P-1", {person, again}, folder);
  REQUIRE(clear.size() == 7);
  CHECK(clear[5].filename() == "PZd1_incidents.csv");
  const std::vector<CsvRow> consents = rows_of(clear[6]);
  REQUIRE(consents.size() == 2);
  CHECK(consents[0].at("consent_version") == "3");
  CHECK(consents[1].at("consent_version") == "4");
  CHECK(clear[0].filename() == "PZd1_sessions.csv");
  CHECK(rows_of(clear[0]).size() == 1);
  CHECK(rows_of(clear[1]).size() == 1);
  CHECK(rows_of(clear[2]).size() == 12);
  CHECK(says(all_text(clear), "somebody@example.org"));
  for (const char* const words : {"P2", "grain", "phone", "ring"}) {
    CHECK_FALSE(says(all_text(clear), words));
  }
  CHECK(rows_of(clear[5]).size() == 7);
  CHECK_FALSE(says(all_text(clear), "response"));

  study.store().look_at("P-1", milliseconds(30), "asked for the data");
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key(), "P-1");
  const auto whole =
      analysis::export_participant({study.store(), &outcomes, &study.key()}, "P-1", {}, folder);
  CHECK(rows_of(whole[2]).size() == 12);
  CHECK(rows_of(whole[2])[0].at("correct") == "1");
  for (const char* const words :
       {"wrote a letter", "by the grain", "a phone rang", "wears a ring"}) {
    CHECK(says(all_text(whole), words));
  }
  CHECK(rows_of(folder / "PZd1_answers.csv").size() == 6);
  CHECK_FALSE(says(all_text(whole), "P2"));
  CHECK_FALSE(std::filesystem::exists(folder / "PZd1_personal.csv"));  // of the export before

  CHECK_THROWS_AS(analysis::export_participant({study.store()}, "P9", {}, folder), StoreError);
}

}  // namespace touchtrial

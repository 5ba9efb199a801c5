#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/fake_study.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"

#include <chrono>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

/// The servo's numbers and the page's list of devices are in no JSON.
void check_same_station(const analysis::Collection& read_back,
                        const analysis::Collection& collection) {
  REQUIRE(read_back.servo_trials.size() == collection.servo_trials.size());
  for (std::size_t i = 0; i < collection.servo_trials.size(); ++i) {
    const analysis::ServoTrial& one = collection.servo_trials[i];
    const analysis::ServoTrial& same = read_back.servo_trials[i];
    CHECK(std::pair(same.session, same.trial) == std::pair(one.session, one.trial));
    CHECK(same.health == one.health);
    CHECK(same.overruns == one.overruns);
  }
  REQUIRE(read_back.sessions.size() == collection.sessions.size());
  for (std::size_t i = 0; i < collection.sessions.size(); ++i) {
    CHECK(read_back.sessions[i].station == collection.sessions[i].station);
  }
  CHECK(read_back.visual == collection.visual);
}

/// Compares the report of a study with the report of its CSV files.
void check_round_trip(FakeStudy& study) {
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const std::filesystem::path out = study.folder() / "out";
  analysis::export_csv(study.store(), outcomes, out);
  const analysis::Outcomes read_back = outcomes_from_csv(out);
  REQUIRE(read_back.trials.size() == outcomes.trials.size());
  for (std::size_t i = 0; i < outcomes.trials.size(); ++i) {
    CHECK(read_back.trials[i].row == outcomes.trials[i].row);
    CHECK(read_back.trials[i].measures == outcomes.trials[i].measures);
  }
  REQUIRE(read_back.sessions.size() == outcomes.sessions.size());
  for (std::size_t i = 0; i < outcomes.sessions.size(); ++i) {
    CHECK(read_back.sessions[i].row == outcomes.sessions[i].row);
  }
  CHECK(read_back.answers == outcomes.answers);
  check_same_station(read_back.collection, outcomes.collection);
  CHECK(analysis::identification::report_json(analysis::identification::make_report(read_back)) ==
        analysis::identification::report_json(analysis::identification::make_report(outcomes)));
}

/// Answers that are sometimes wrong, in a way that depends on the participant.
FakeAnswers imperfect(int participant) {
  return [=](const study::Trial& shown) -> std::optional<int> {
    if ((shown.place.trial + participant) % 7 == 0) return std::nullopt;
    if ((shown.place.trial * participant) % 3 == 0) return (shown.field().class_index + 1) % 3;
    return shown.field().class_index;
  };
}

void fill(FakeStudy& study) {
  for (int i = 1; i <= 5; ++i) {
    study.add({.participant = "P0" + std::to_string(i),
               .enrolment = i,
               .answers = imperfect(i),
               .valid = i != 2,
               .within_limits = i != 3,
               .interrupt_trial = i == 4 ? 3 : 0,
               .hand = {.force = i != 5}});
  }
  study.add({.participant = "P06",
             .enrolment = 6,
             .answers = imperfect(6),
             .complete = false,
             .stop_after = 4});
}

}  // namespace

TEST_CASE("A classification study reports the same from its CSV files, to the last digit") {
  FakeStudy study({.label = "bark, \"old\" (two, three)"});
  fill(study);
  study.store().exclude(1, milliseconds(900), "fell asleep, \"twice\"");
  study.close_and_unblind();
  check_round_trip(study);
}

TEST_CASE("A comparison of methods reports the same from its CSV files, to the last digit") {
  FakeStudy study(study::identification::comparison());
  fill(study);
  study.store().withdraw(2, milliseconds(900), "asked to");
  study.close_and_unblind();
  check_round_trip(study);
}

TEST_CASE("A study with lead-ins and catch trials reports the same from its CSV files") {
  FakeStudy study({.trials = R"({"lead_in": 1, "catch": 2})"});
  fill(study);
  study.close_and_unblind();
  check_round_trip(study);
  CHECK(rows_of(study.folder() / "out" / "unscored_trials.csv").size() == 5 * 3 + 1);
}

TEST_CASE("How a study was collected is the same from its CSV files, in words and numbers") {
  FakeStudy study({.simulated = false});
  fill(study);
  FakeSession felt{.participant = "P07", .enrolment = 7, .answers = imperfect(7)};
  felt.station = record::StationRecord{"Falcon",         "1.2, beta",     8.9,      false,
                                       1000.0,           "SCHED_FIFO 80", "c0ffee", std::nullopt,
                                       {1.0, 1.25, 0.8}, {1.0, 1.0, 1.5}};
  felt.servo = record::ServoHealth{999.75, 1.5, 40.25, 80.125, 1e3 / 3.0, 2, 17};
  felt.before_trials = [](record::SessionRecorder& recorder) {
    recorder.add(milliseconds(10), record::EventKind::practised,
                 record::PracticeBody{
                     .round = 1, .presentation = 1, .answer = ChoiceAnswer{0}, .correct = false});
    recorder.add(milliseconds(20), record::EventKind::practised,
                 record::PracticeBody{
                     .round = 2, .presentation = 1, .answer = ChoiceAnswer{0}, .correct = true});
    recorder.add(milliseconds(40), record::EventKind::deviated,
                 record::DeviationBody{"no-masking-noise", "no \"sound\" card,\nnone"});
    recorder.add(milliseconds(45), record::EventKind::deviated,
                 record::DeviationBody{"practice-not-passed", ""});
    recorder.add(milliseconds(70), record::EventKind::resumed,
                 record::ResumedBody{.after = "program-ended", .away_s = 60.0});
  };
  study.add(felt);
  study.store().note(7, milliseconds(800), "moved-hand", "during trial 3");
  study.store().note(2, milliseconds(810), "late", "came late");
  study.store().withdraw(2, milliseconds(850), "asked to");
  study.store().exclude(3, milliseconds(900), "did not follow, at all");
  study.store().replace(6, "P08", milliseconds(950), "the device failed");
  study.add({.participant = "P08", .enrolment = 6, .answers = imperfect(8)});
  study.close_and_unblind();
  check_round_trip(study);
  const std::filesystem::path out = study.folder() / "out";
  CHECK(rows_of(out / "servo.csv").size() == 12);
  CHECK(rows_of(out / "deviations.csv").size() == 3);
  const std::vector<CsvRow> people = rows_of(out / "participants.csv");
  CHECK(people[2].at("exclusion_reason") == "did not follow, at all");
  CHECK(people[5].at("replacement_reason") == "the device failed");
  CHECK(people[6].at("practice_passed") == "0");
}

TEST_CASE("What participants said reports the same from its CSV files") {
  FakeStudy study({.session = R"({"closing_questions": [
    {"id": "hard", "kind": "number", "text": {"en": "How hard was it?"}},
    {"id": "which", "kind": "choice", "text": {"en": "Which was best?"},
     "options": [{"en": "rough"}, {"en": "smooth"}]}]})"});
  study.add(talkative("P01", 1, R"({"hard":7,"remarks":"two \"quotes\",\nand a line","which":1})"));
  study.add(talkative("P02", 2, R"({"hard":2.5,"which":0})"));
  study.add(talkative("P03", 3, R"({"hard":4,"which":1})"));
  study.close_and_unblind();
  check_round_trip(study);
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  const auto said = analysis::question_summaries(outcomes);
  REQUIRE(said.size() == 3);
  CHECK(said[0].question == "hard");
  CHECK(said[0].numbers.median == 4.0);
  CHECK(said[1].options.at(0).people == 1);
  CHECK(said[1].options.at(1).people == 2);
  CHECK(said[2].texts.size() == 1);
}

TEST_CASE("An interim look reports the same from its CSV files") {
  FakeStudy study(study::identification::classification());
  fill(study);
  study.store().unblind(milliseconds(1000), "safety", true);
  study.add({.participant = "P07", .enrolment = 7, .answers = imperfect(7)});
  check_round_trip(study);
}

TEST_CASE("Participants who are no simulation are not stamped, and report the same") {
  FakeStudy study({.simulated = false});
  fill(study);
  study.close_and_unblind();
  check_round_trip(study);
  for (const CsvRow& row : rows_of(study.folder() / "out" / "trials.csv")) {
    CHECK(row.at("simulated") == "0");
  }
}

}  // namespace touchtrial

#include "analysis/outcomes/collection.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/collection_records.hpp"
#include "analysis/outcomes/quality.hpp"
#include "analysis/report/json_figures.hpp"
#include "core/errors.hpp"
#include "support/catch.hpp"

#include <chrono>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;

FakeSession session_of(const std::string& participant, int enrolment) {
  return {.participant = participant, .enrolment = enrolment};
}

record::StationRecord falcon() {
  record::StationRecord station;
  station.model = "Falcon";
  return station;
}

int sum_of(const analysis::ParticipantFlow& flow) {
  return flow.erased + flow.replaced + flow.excluded + flow.stopped + flow.open + flow.other_kind +
         flow.unseen + flow.analysed;
}

}  // namespace

TEST_CASE("load_collection tells what the study prescribes") {
  FakeStudy study({.trials = R"({"explore_limit_s": 30, "on_timeout": "no-response"})"});
  const analysis::Prescription prescription = analysis::load_collection(study.store()).prescription;
  CHECK(prescription.explore_limit_s == 30.0);
  CHECK(prescription.on_timeout == "no-response");
  CHECK(prescription.order == "shuffled");
  CHECK(prescription.repeats == 4);
  CHECK(prescription.sight == "curtain");
  CHECK(prescription.masking_wanted);
  CHECK(prescription.masking_dbfs == -30.0);
  CHECK(prescription.validity == study::ValidityRule{});
}

TEST_CASE("A prescription has the validity rule that the study sets") {
  FakeStudy study({.trials = R"({"validity": {"contact_s": 2.5, "saturated_share": 0.5}})"});
  CHECK(analysis::load_collection(study.store()).prescription.validity ==
        study::ValidityRule{.min_contact_s = 2.5, .saturated_share = 0.5});
}

TEST_CASE("A prescription follows the section on sessions where there is one") {
  const analysis::Prescription prescription = analysis::prescription_from_json(
      R"({"trials":{"explore_limit_s":5,"on_timeout":"fade","order":"uniform","repeats":2},
          "session":{"sight":"blindfold","masking":{"wanted":false,"level_dbfs":-40.5}}})");
  CHECK(prescription.sight == "blindfold");
  CHECK_FALSE(prescription.masking_wanted);
  CHECK(prescription.masking_dbfs == -40.5);
  CHECK_THROWS_AS(analysis::prescription_from_json("{}"), StoreError);
  CHECK_THROWS_AS(analysis::prescription_from_json("no JSON"), StoreError);
}

TEST_CASE("A session's record holds practice, deviations, resumptions and station") {
  FakeStudy study({.simulated = false});
  FakeSession session = session_of("P01", 1);
  session.station = falcon();
  session.servo = record::ServoHealth{.rate_hz = 998.0, .lateness_p99_us = 40.0};
  session.before_trials = [](record::SessionRecorder& recorder) {
    const auto practise = [&](milliseconds at, int round, int presentation, bool correct) {
      recorder.add(at, record::EventKind::practised,
                   record::PracticeBody{round, presentation, ChoiceAnswer{0}, correct});
    };
    practise(milliseconds(10), 1, 1, false);
    practise(milliseconds(20), 2, 1, true);
    practise(milliseconds(30), 2, 2, true);
    recorder.add(milliseconds(40), record::EventKind::deviated,
                 record::DeviationBody{"no-masking-noise", "no sound card"});
    recorder.add(milliseconds(50), record::EventKind::deviated,
                 record::DeviationBody{"no-masking-noise", "no sound card"});
    recorder.add(milliseconds(60), record::EventKind::resumed,
                 record::ResumedBody{.after = "pause", .away_s = 3.0});
    recorder.add(milliseconds(70), record::EventKind::resumed,
                 record::ResumedBody{.after = "program-ended", .away_s = 60.0});
  };
  study.add(session);
  study.store().note(1, milliseconds(100), "moved-hand", "during trial 3");
  study.store().note(1, milliseconds(110), "", "a remark is no deviation");

  const analysis::Collection collection =
      analysis::load_collection(study.store(), analysis::person_keys(study.store(), study.key()));
  REQUIRE(collection.sessions.size() == 1);
  const analysis::SessionRecord& record = collection.sessions[0];
  CHECK(record.row.participant == "P01");
  REQUIRE(record.practice);
  CHECK(record.practice->rounds == 2);
  CHECK(record.practice->presentations == 3);
  CHECK(record.practice->correct == 2);
  CHECK(record.practice->passed);
  REQUIRE(record.deviations.size() == 2);
  CHECK(record.deviations[0].code == "no-masking-noise");
  CHECK(record.deviations[0].text == "no sound card");
  CHECK(record.deviations[1].text == "during trial 3");
  CHECK(record.resumed == 1);
  REQUIRE(record.station);
  CHECK(record.station->model == "Falcon");
  REQUIRE(collection.servo_trials.size() == 12);
  CHECK(collection.servo_trials[11].trial == 12);
  CHECK(collection.servo_trials[11].health.lateness_p99_us == 40.0);
  CHECK_FALSE(collection.visual);
}

TEST_CASE("The dates of collecting are those of sessions in real time that were not erased") {
  std::vector<analysis::SessionRecord> sessions(4);
  CHECK_FALSE(analysis::dates_of(sessions));
  sessions[1].opened_utc = "2026-02-11T10:00:00Z";
  CHECK(analysis::dates_of(sessions)->first == "2026-02-11");
  sessions[2].opened_utc = "2026-01-31";
  sessions[3].opened_utc = "2026-01-30T10:00:00Z";
  sessions[3].row.erased = true;
  CHECK(analysis::dates_of(sessions)->first == "2026-01-31");
  CHECK(analysis::dates_of(sessions)->last == "2026-02-11");
  analysis::Collection collection;
  CHECK(analysis::collection_object(collection)["dates"].is_null());
  collection.sessions = sessions;
  CHECK(analysis::collection_object(collection)["dates"]["last"] == "2026-02-11");
}

TEST_CASE("Without the key a record lacks what a session's people said and answered") {
  FakeStudy study(study::identification::classification());
  FakeSession session = session_of("P01", 1);
  session.before_trials = [](record::SessionRecorder& recorder) {
    recorder.add(milliseconds(10), record::EventKind::practised,
                 record::PracticeBody{1, 1, ChoiceAnswer{0}, true});
    recorder.add(milliseconds(40), record::EventKind::deviated,
                 record::DeviationBody{"no-masking-noise", "no sound card"});
  };
  study.add(session);
  const analysis::Collection collection = analysis::load_collection(study.store());
  const analysis::SessionRecord& record = collection.sessions.at(0);
  REQUIRE(record.practice);
  CHECK(record.practice->presentations == 1);
  CHECK_FALSE(record.practice->correct);
  REQUIRE(record.deviations.size() == 1);
  CHECK(record.deviations[0].code == "no-masking-noise");
  CHECK(record.deviations[0].text.empty());
  CHECK(record.answers == 12);
  CHECK_FALSE(record.spread);
}

TEST_CASE("Practice that did not reach its criterion is reported") {
  FakeStudy study(study::identification::classification());
  FakeSession session = session_of("P01", 1);
  session.before_trials = [](record::SessionRecorder& recorder) {
    recorder.add(milliseconds(10), record::EventKind::practised,
                 record::PracticeBody{1, 1, ChoiceAnswer{0}, false});
    recorder.add(milliseconds(20), record::EventKind::deviated,
                 record::DeviationBody{"practice-not-passed", "0 of 1"});
  };
  study.add(session);
  study.add(session_of("P02", 2));
  const analysis::Collection collection = analysis::load_collection(study.store());
  CHECK_FALSE(collection.sessions[0].practice->passed);
  CHECK_FALSE(collection.sessions[1].practice);
}

TEST_CASE("Every participant is counted once, by the session that stands") {
  FakeStudy study(study::identification::classification());
  study.add(session_of("complete", 1));
  FakeSession stopped = session_of("stopped", 2);
  stopped.complete = false;
  stopped.before_trials = [](record::SessionRecorder& recorder) {
    recorder.add(milliseconds(10), record::EventKind::stopped,
                 record::StopBody{.text = "felt unwell"});
  };
  study.add(stopped);
  study.add(session_of("asleep", 3));
  study.add(session_of("withdrew", 4));
  stopped.participant = "gave-way";
  stopped.enrolment = 5;
  study.add(stopped);
  stopped.participant = "again";
  stopped.enrolment = 6;
  study.add(stopped);
  record::StudyStore& store = study.store();
  store.exclude(3, milliseconds(10), "fell asleep");
  store.withdraw(4, milliseconds(20), "no reason");
  store.replace(5, "successor", milliseconds(30), "did not finish");
  study.add(session_of("successor", 5));
  store.replace(6, "again", milliseconds(40), "power cut");
  study.add(session_of("again", 6));

  const analysis::Collection blind = analysis::load_collection(store);
  CHECK(blind.flow.exclusion_reasons == std::vector<std::string>{"(sealed)"});
  CHECK(blind.sessions[1].stop_reason == "(sealed)");
  CHECK(blind.sessions[4].replacement_reason == "(sealed)");
  const analysis::Collection collection =
      analysis::load_collection(store, analysis::person_keys(store, study.key()));
  const analysis::ParticipantFlow& flow = collection.flow;
  CHECK(flow.enrolled == 7);
  CHECK(flow.analysed == 3);  // complete, successor, again
  CHECK(flow.stopped == 1);
  CHECK(flow.excluded == 1);
  CHECK(flow.exclusion_reasons == std::vector<std::string>{"fell asleep"});
  CHECK(flow.erased == 1);
  CHECK(flow.withdrawn == 1);
  CHECK(flow.replaced == 1);
  CHECK(flow.open == 0);
  CHECK(sum_of(flow) == flow.enrolled);
  REQUIRE(collection.sessions.size() == 8);
  CHECK(collection.sessions[1].stop_reason == "felt unwell");
  CHECK(collection.sessions[2].exclusion_reason == "fell asleep");
  CHECK(collection.sessions[4].replacement_reason == "did not finish");
}

TEST_CASE("A collection holds nothing about an erased participant except the withdrawal") {
  FakeStudy study({.simulated = false});
  FakeSession session = session_of("P01", 1);
  session.station = falcon();
  session.servo = record::ServoHealth{};
  session.before_trials = [](record::SessionRecorder& recorder) {
    recorder.add(milliseconds(40), record::EventKind::deviated,
                 record::DeviationBody{"no-curtain", "told a name"});
  };
  study.add(session);
  study.store().exclude(1, milliseconds(10), "told a name");
  study.store().withdraw(1, milliseconds(20), "");
  const analysis::Collection collection =
      analysis::load_collection(study.store(), analysis::person_keys(study.store(), study.key()));
  REQUIRE(collection.sessions.size() == 1);
  const analysis::SessionRecord& record = collection.sessions[0];
  CHECK(record.row.withdrawn);
  CHECK(record.row.participant.empty());
  CHECK(record.deviations.empty());
  CHECK(record.exclusion_reason.empty());
  CHECK_FALSE(record.station);
  CHECK(collection.servo_trials.empty());
  CHECK(collection.flow.erased == 1);
  CHECK(collection.flow.exclusion_reasons.empty());
}

TEST_CASE("Who withdraws and lets the data be used is counted like the others, and told apart") {
  FakeStudy study(study::identification::classification());
  study.add(session_of("P01", 1));
  study.add(session_of("P02", 2));
  study.store().withdraw(1, milliseconds(10), "moves away", record::Retention::data);
  const analysis::Collection blind = analysis::load_collection(study.store());
  CHECK(blind.flow.analysed == 2);
  CHECK(blind.flow.withdrawn == 1);
  CHECK(blind.flow.erased == 0);
  CHECK(blind.sessions[0].row.participant == "P01");
  CHECK(blind.sessions[0].withdrawal_reason == "(sealed)");
  const analysis::Collection opened =
      analysis::load_collection(study.store(), analysis::person_keys(study.store(), study.key()));
  CHECK(opened.sessions[0].withdrawal_reason == "moves away");
  study.store().withdraw(1, milliseconds(20), "changed her mind");
  CHECK(analysis::load_collection(study.store()).flow.erased == 1);
}

TEST_CASE("A participant who completes after an interim look is not analysed yet") {
  FakeStudy study(study::identification::classification());
  study.add(session_of("P01", 1));
  CHECK(analysis::load_collection(study.store()).flow.analysed == 1);  // blind: to be analysed
  study.store().unblind(milliseconds(100), "safety", true);
  study.add(session_of("P02", 2));
  const analysis::ParticipantFlow flow = analysis::load_collection(study.store()).flow;
  CHECK(flow.enrolled == 2);
  CHECK(flow.analysed == 1);
  CHECK(flow.unseen == 1);
  study.close_and_unblind();
  CHECK(analysis::load_collection(study.store()).flow.analysed == 2);
}

}  // namespace touchtrial

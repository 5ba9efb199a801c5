#include "analysis/outcomes/quality.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "analysis/report/json_figures.hpp"
#include "analysis/report/page/study_document.hpp"
#include "analysis/text_matching.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "support/catch.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

/// Three sessions: one right but for a time-out, one not valid, one stopped after four trials.
void fill(FakeStudy& study) {
  study.add({.participant = "P01", .enrolment = 1, .answers = [](const study::Trial& shown) {
               return shown.place.trial == 3 ? std::nullopt
                                             : std::optional(shown.field().class_index);
             }});
  study.add({.participant = "P02", .enrolment = 2, .valid = false, .interrupt_trial = 2});
  study.add({.participant = "P03", .enrolment = 3, .complete = false, .stop_after = 4});
}

/// The report as the terminal shows it.
std::string page_of(const analysis::QualityReport& report) {
  return analysis::document_text(analysis::quality_document(report, {}));
}

}  // namespace

TEST_CASE("make_quality counts sessions, answers and validity without a key") {
  FakeStudy study(study::identification::classification());
  fill(study);
  const analysis::QualityReport report = analysis::make_quality(study.store());
  CHECK(report.participants == 2);
  CHECK(report.trials == 24);
  CHECK(report.sessions.completed == 2);
  CHECK(report.sessions.stopped == 1);
  CHECK(report.sessions.withdrawn == 0);
  const analysis::TrialQuality& quality = report.quality;
  CHECK(quality.presented == 28);
  CHECK(quality.answered == 27);
  CHECK(quality.no_response == 1);
  CHECK(quality.interrupted == 1);
  CHECK(quality.not_repeated == 0);
  CHECK(quality.with_trace == 28);
  CHECK(quality.valid == 16);
  CHECK(quality.lowest_rate_hz == 1000.0);
}

TEST_CASE("A quality report counts interruptions, repeated or not, pauses and notes") {
  FakeStudy study(study::identification::classification());
  study.add(talkative("P01", 1, "{}"));
  study.add({.participant = "P02",
             .enrolment = 2,
             .complete = false,
             .interrupt_trial = 1,
             .stop_after = 1});
  study.add(talkative("P03", 3, "{}"));
  study.store().withdraw(3, std::chrono::milliseconds(40), "");
  const analysis::QualityReport report = analysis::make_quality(study.store());
  CHECK(report.quality.interrupted == 4);
  CHECK(report.quality.not_repeated == 0);
  const analysis::SessionRecord& one = report.collection.sessions.at(0);
  CHECK(one.interruptions == 3);
  CHECK(one.pauses == 1);
  CHECK(one.notes == 1);
  CHECK(report.collection.sessions.at(2).interruptions == 0);
  const auto json = nlohmann::json::parse(analysis::quality_json(report));
  CHECK(json["responses"]["interrupted"] == 4);
  CHECK(json["responses"]["not_repeated"] == 0);
  CHECK(json["collection"]["sessions"][0]["interruptions"] == 3);
}

TEST_CASE("A quality report names who presses one key, and how answers are spread stays sealed") {
  FakeStudy study(study::identification::classification());
  const auto first = [](const study::Trial&) { return 0; };
  study.add({.participant = "P01", .enrolment = 1, .answers = first, .one_key = true});
  study.add({.participant = "P02", .enrolment = 2});
  const auto sessions = [](const analysis::Collection& collection) {
    return analysis::collection_object(collection)["sessions"];
  };
  const auto blind = sessions(analysis::make_quality(study.store()).collection);
  CHECK(blind[0]["answers"].dump() == R"({"n":12,"one_key":true})");
  CHECK(blind[1]["answers"].dump() == R"({"n":12,"one_key":false})");
  study.close_and_unblind();
  const auto shown = sessions(analysis::load_outcomes(study.store(), study.key()).collection);
  CHECK(shown[0]["answers"]["largest_share"] == 1.0);
  CHECK(shown[0]["answers"]["longest_run"] == 12);
  CHECK(shown[1]["answers"]["different"] == 3);
  CHECK(shown[1]["answers"]["median_s"] == 4.3);
}

TEST_CASE("A quality report shows by session in how many trials the hand was outside a window") {
  FakeStudy study(study::identification::classification());
  FakeSession session{.participant = "P01", .enrolment = 1};
  session.hand = {.path = false, .speed = false};
  study.add(session);
  study.add({.participant = "P02", .enrolment = 2});
  study.add({.participant = "P03", .enrolment = 3});
  study.store().withdraw(3, std::chrono::milliseconds(40), "");
  const analysis::QualityReport report = analysis::make_quality(study.store());
  const auto& sessions = report.collection.sessions;
  CHECK(sessions.at(0).outside == analysis::HandCounts{.trials = 12, .path = 6, .speed = 6});
  CHECK(sessions.at(1).outside == analysis::HandCounts{.trials = 12});
  CHECK(sessions.at(2).outside == analysis::HandCounts{});
  const auto outside = nlohmann::json::parse(analysis::quality_json(report))["outside"];
  REQUIRE(outside.size() == 2);
  CHECK(outside[0]["speed"] == 6);
}

TEST_CASE("make_quality counts every session once, and replaced ones apart") {
  FakeStudy study(study::identification::classification());
  fill(study);
  using std::chrono::milliseconds;
  study.store().replace(3, "P04", milliseconds(10), "went home");
  study.add({.participant = "P04", .enrolment = 3});
  study.store().exclude(1, milliseconds(20), "fell asleep");
  study.store().replace(1, "P05", milliseconds(30), "place is wanted");
  const analysis::SessionCounts counts = analysis::make_quality(study.store()).sessions;
  CHECK(counts.completed == 2);
  CHECK(counts.stopped == 0);
  CHECK(counts.excluded == 0);
  CHECK(counts.replaced == 2);
  study.store().withdraw(1, milliseconds(40), "");
  CHECK(analysis::make_quality(study.store()).sessions.replaced == 1);
  CHECK(analysis::make_quality(study.store()).sessions.withdrawn == 1);
}

TEST_CASE("A quality report names no class, no image and no method") {
  FakeStudy study(study::identification::comparison(), {.label = "petrified wood"});
  study.add({.participant = "P01"});
  const analysis::QualityReport report = analysis::make_quality(study.store());
  for (const std::string& text : {analysis::quality_json(report), page_of(report)}) {
    for (const char* secret : {"petrified", "cloth", "straw", ".png", "adaptive", "tv-gabor"}) {
      CHECK_FALSE(contains(text, secret));
    }
  }
}

TEST_CASE("A quality report says how the study stands") {
  FakeStudy study(study::identification::classification());
  CHECK(analysis::make_quality(study.store()).state.closed == false);
  const auto open =
      nlohmann::json::parse(analysis::quality_json(analysis::make_quality(study.store())));
  CHECK(open["state"] == "collecting");
  CHECK(open["blinded"] == true);
  CHECK(open["interim"] == false);
  CHECK(open["pilot"] == false);
  CHECK(open["stamp"] == "SIMULATED");
  CHECK(open["validity"]["share"].is_null());
  study.store().close_study(std::chrono::seconds(1));
  CHECK(nlohmann::json::parse(
            analysis::quality_json(analysis::make_quality(study.store())))["state"] == "closed");
  study.store().unblind(std::chrono::seconds(2), "planned", false);
  const auto done =
      nlohmann::json::parse(analysis::quality_json(analysis::make_quality(study.store())));
  CHECK(done["state"] == "unblinded");
  CHECK(done["blinded"] == false);
}

TEST_CASE("A quality report shows how the servo kept its time, where that was recorded") {
  FakeStudy study({.simulated = false});
  study.add({.participant = "P01"});
  CHECK_FALSE(analysis::make_quality(study.store()).servo);
  FakeSession session{.participant = "P02", .enrolment = 2};
  session.station = record::StationRecord();
  session.station->scheduling = "fifo 80, memory locked";
  session.servo = record::ServoHealth{.rate_hz = 999.5,
                                      .lateness_p50_us = 3.0,
                                      .lateness_p99_us = 63.0,
                                      .lateness_p999_us = 210.0,
                                      .lateness_worst_us = 1700.0,
                                      .lost = 2,
                                      .held = 3};
  study.add(session);
  const analysis::QualityReport report = analysis::make_quality(study.store());
  REQUIRE(report.servo);
  CHECK(report.servo->trials == 12);
  CHECK(report.servo->median_p99_us == 63.0);
  CHECK(report.servo->worst_us == 1700.0);
  CHECK(report.servo->lost == 24);
  const auto json = nlohmann::json::parse(analysis::quality_json(report));
  CHECK(json["servo"]["lateness_us"]["highest_p99"] == 63.0);
  CHECK(json["servo"]["scheduling"].size() == 1);
}

TEST_CASE("What was seen on a screen says so in every report") {
  FakeStudy study({.simulated = false, .pilot = true});
  FakeSession session{.participant = "P01"};
  session.station = record::StationRecord();
  session.station->visual = true;
  study.add(session);
  const analysis::QualityReport report = analysis::make_quality(study.store());
  CHECK(report.visual);
  analysis::QualityReport felt = report;
  felt.visual = false;
  CHECK(page_of(report) != page_of(felt));
  study.close_and_unblind();
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(outcomes.visual);
  analysis::Outcomes felt_outcomes = outcomes;
  felt_outcomes.visual = false;
  CHECK(analysis::identification::make_report(outcomes).warnings.size() ==
        analysis::identification::make_report(felt_outcomes).warnings.size() + 1);
}

TEST_CASE("A quality report of real participants carries no stamp") {
  FakeStudy study({.simulated = false});
  const analysis::QualityReport report = analysis::make_quality(study.store());
  const auto json = nlohmann::json::parse(analysis::quality_json(report));
  CHECK(json["simulated"] == false);
  CHECK_FALSE(json.contains("stamp"));
  CHECK_FALSE(contains(page_of(report), "SIMULATED"));
}

}  // namespace touchtrial

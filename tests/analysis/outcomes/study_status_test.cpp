#include "analysis/outcomes/study_status.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/collection_records.hpp"
#include "analysis/outcomes/quality.hpp"
#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/page/study_document.hpp"
#include "analysis/text_matching.hpp"
#include "study/deviation_codes.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using analysis::PersonStatus;
using analysis::StudyStatus;
using std::chrono::milliseconds;

/// What the report's JSON says of the devices' certificates, before and after unblinding.
std::pair<bool, bool> unverified_in_json(FakeStudy& study) {
  const auto told = [](const std::string& text) {
    return nlohmann::json::parse(text).at("unverified_device").get<bool>();
  };
  const bool blind = told(analysis::quality_json(analysis::make_quality(study.store())));
  analysis::StudyHead head;
  head.collection = analysis::load_collection(study.store());
  const bool open = told(analysis::framed_json(head, "{}"));
  return {blind, open};
}

/// One complete with a certificate, one without, one open, one stopped whose place P05 takes.
void fill(FakeStudy& study) {
  FakeSession felt{.participant = "P01", .enrolment = 1};
  felt.station = record::StationRecord();
  felt.station->calibration = "c0ffee";
  study.add(felt);
  felt.participant = "P02";
  felt.enrolment = 2;
  felt.before_trials = [](record::SessionRecorder& recorder) {
    recorder.add(milliseconds(1), record::EventKind::deviated,
                 record::DeviationBody{"no-certificate", ""});
  };
  study.add(felt);
  study.add({.participant = "P03", .enrolment = 3, .complete = false, .stop_after = 2});
  study.add({.participant = "P04", .enrolment = 4, .stop_after = 3, .ends = false});
  study.store().replace(3, "P05", milliseconds(20), "went home");
}

const PersonStatus& person(const StudyStatus& status, const std::string& id) {
  const auto found = std::ranges::find(status.people, id, &PersonStatus::participant);
  REQUIRE(found != status.people.end());
  return *found;
}

bool has_left(const StudyStatus& status, const std::string& places) {
  return std::ranges::any_of(status.tasks,
                             [&](const std::string& one) { return names(one, places); });
}

}  // namespace

TEST_CASE("A study's status says who is done, who is open, who is to come and what is left") {
  FakeStudy study(study::identification::comparison(), {.simulated = false});
  fill(study);
  analysis::StatusSources sources{.consents = {{.participant = "P01", .consent_version = "1"},
                                               {.participant = "P01", .consent_version = "2"},
                                               {.participant = "P02", .consent_version = "1"},
                                               {.participant = "P04", .consent_version = "2"},
                                               {.participant = "P06", .consent_version = "2"}},
                                  .has_consents = true,
                                  .planned = 6,
                                  .consent_version = "2"};
  const StudyStatus status = analysis::status_of(study.store(), sources);
  CHECK(status.complete == 2);
  REQUIRE(status.people.size() == 6);
  CHECK(person(status, "P01").state == "complete");
  CHECK(person(status, "P01").consent == "2");
  CHECK(person(status, "P01").certificate == "c0ffee");
  CHECK(person(status, "P01").answered == 24);
  CHECK(person(status, "P01").ended_utc == "1970-01-01T00:00:00Z");
  CHECK(person(status, "P02").certificate.empty());
  CHECK(person(status, "P03").state == "replaced");
  CHECK(person(status, "P04").state == "open");
  CHECK(person(status, "P04").can_resume);
  CHECK(person(status, "P04").answered == 3);
  CHECK(person(status, "P04").ended_utc.empty());
  CHECK(person(status, "P05").state == "to come");
  CHECK(person(status, "P05").enrolment == 3);
  CHECK(person(status, "P05").in_place_of == "P03");
  CHECK(person(status, "P06").session == 0);
  CHECK(has_left(status, "P04"));
  CHECK(has_left(status, "P05 P03 3"));
  CHECK(has_left(status, "P03 P05"));
  CHECK(has_left(status, "P02 2"));
  CHECK(has_left(status, "P02"));
  CHECK(has_left(status, "4 6"));
  REQUIRE(status.orders);
  CHECK(status.orders->orders == 2);
  CHECK(status.orders->complete == 1);
  CHECK(status.orders->open == std::vector<int>{0});
}

TEST_CASE("A session without a valid certificate is stamped in status, reports and their tables") {
  FakeStudy study({.simulated = false});
  FakeSession felt{.participant = "P01", .enrolment = 1};
  felt.station = record::StationRecord();
  felt.station->calibration = "c0ffee";
  study.add(felt);
  CHECK_FALSE(analysis::provenance_of(study.store(), "study.db").unverified);
  CHECK(unverified_in_json(study) == std::pair(false, false));
  felt.participant = "P02";
  felt.enrolment = 2;
  felt.station->calibration = study::kUnverifiedDevice;
  study.add(felt);
  const StudyStatus status = analysis::status_of(study.store(), {});
  CHECK(person(status, "P02").certificate == "UNVERIFIED DEVICE");
  CHECK(has_left(status, "P02: UNVERIFIED DEVICE"));
  CHECK_FALSE(has_left(status, "P01"));
  CHECK(contains(analysis::status_text(status, {}), "UNVERIFIED DEVICE"));
  const analysis::Provenance provenance = analysis::provenance_of(study.store(), "study.db");
  CHECK(provenance.unverified);
  CHECK(unverified_in_json(study) == std::pair(true, true));
  CHECK(analysis::further_stamp(true, provenance) == "PILOT, UNVERIFIED DEVICE");
  CHECK(analysis::further_stamp(false, provenance) == "UNVERIFIED DEVICE");
}

TEST_CASE("A session that was resumed without a valid certificate is stamped too") {
  FakeStudy study({.simulated = false});
  FakeSession felt{.participant = "P01", .enrolment = 1};
  felt.station = record::StationRecord();
  felt.station->calibration = "c0ffee";
  felt.before_trials = [](record::SessionRecorder& recorder) {
    recorder.add(milliseconds(1), record::EventKind::deviated,
                 record::DeviationBody{"unverified-device", "resumed"});
  };
  study.add(felt);
  CHECK(analysis::provenance_of(study.store(), "study.db").unverified);
}

TEST_CASE("A study's status has no word of stimuli and answers, and is the same as JSON") {
  FakeStudy study(study::identification::comparison(),
                  {.simulated = false, .label = "petrified wood"});
  fill(study);
  const StudyStatus status = analysis::status_of(study.store(), {});
  const std::string text = analysis::status_text(status, {{"session of P05", "touchtrial run"}});
  const std::string json = analysis::status_json(status, {{"session of P05", "touchtrial run"}});
  for (const std::string& page : {text, json}) {
    for (const char* secret : {"petrified", "cloth", "straw", ".png", "adaptive", "tv-gabor"}) {
      CHECK_FALSE(contains(page, secret));
    }
    CHECK(contains(page, "touchtrial run"));
  }
  CHECK(names(text, "2 1"));
  const auto object = nlohmann::json::parse(json);
  CHECK(object["state"] == "collecting");
  CHECK(object["planned"].is_null());
  CHECK(object["people"].size() == 5);
  CHECK(object["people"][3]["may_go_on"] == true);
  CHECK(object["next"][0]["what"] == "session of P05");
  // Nothing is known of consents, and nobody is said to lack one.
  CHECK_FALSE(has_left(status, "no consent"));
}

TEST_CASE("A study's status tells what closes it, and names nobody who was erased") {
  FakeStudy study({.simulated = false});
  study.add({.participant = "P01", .enrolment = 1});
  study.add({.participant = "P02", .enrolment = 2});
  study.store().withdraw(2, milliseconds(30), "asked to");
  analysis::StatusSources sources{.planned = 1};
  CHECK(has_left(analysis::status_of(study.store(), sources), "`touchtrial close`"));
  study.store().close_study(milliseconds(40));
  const StudyStatus closed = analysis::status_of(study.store(), sources);
  CHECK(has_left(closed, "`touchtrial unblind`"));
  CHECK(closed.people.at(1).state == "erased");
  CHECK_FALSE(contains(analysis::status_text(closed, {}), "P02"));
  CHECK_FALSE(closed.orders);
  study.store().unblind(milliseconds(50), "planned", false);
  CHECK(analysis::status_of(study.store(), sources).tasks.empty());
}

}  // namespace touchtrial

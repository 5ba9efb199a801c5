// status: how collection stands, and the next participant's command.
#include "app/study_folder.hpp"
#include "core/cipher.hpp"
#include "record/personal_data.hpp"
#include "record/session_recorder.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"
#include "support/catch.hpp"

#include <chrono>

namespace touchtrial {
namespace {

/// A database of people, without a session, as the first `run` makes it.
void begin_database(const StudyFolder& folder, const std::string& station_file,
                    bool pilot = false) {
  const study::StationKey key = study::load_station_key(folder.path() / station_file);
  record::StudyCommitment commitment;
  commitment.study = key.study.name;
  commitment.protocol = key.study.protocol_name();
  commitment.study_id = key.study_id;
  commitment.seal = key.seal;
  commitment.configuration = key.configuration;
  commitment.scored_trials = key.study.scored_trials();
  commitment.positions = 3;
  commitment.pilot = pilot;
  commitment.investigator = key.investigator_signature;
  commitment.station = {
      .name = key.station.name, .key = key.signer().public_half(), .certificate = key.certificate};
  static_cast<void>(record::StudyStore::create(folder.path() / "study.db", commitment,
                                               std::chrono::seconds(1), key.signer()));
}

/// A participant's complete session, opened so long ago.
void add_session(const StudyFolder& folder, const std::string& participant, int enrolment,
                 int visit, std::chrono::hours ago) {
  const study::StationKey key = study::load_station_key(folder.path() / "cloths.station");
  record::StudyStore store =
      record::StudyStore::open(folder.path() / "study.db", record::StudyStore::Access::read_write);
  store.sign_with(key.signer());
  const int number = store.next_session();
  SystemEntropy entropy;
  const SecretKey own = entropy.secret("participant");
  record::BufferedEvents buffer;
  record::SessionRecorder recorder(number, own, buffer);
  record::SessionOpening opening{.participant = participant,
                                 .enrolment = enrolment,
                                 .visit = visit,
                                 .study_id = key.study_id,
                                 .seal = key.seal,
                                 .device = "falcon",
                                 .pilot = store.commitment().pilot};
  recorder.opened({}, opening, "{}");
  recorder.closed(std::chrono::seconds(1), true);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  store.add_session(buffer, record::wrap_participant_key(key.investigator_box, number, own),
                    std::chrono::duration_cast<std::chrono::nanoseconds>(now - ago));
}

/// A study of two visits, a week apart, with a plan.
void write_visits(const StudyFolder& folder, int planned) {
  folder.write_study({{"visits", {{"count", 2}, {"least_days", 7}}},
                      {"registration", {{"participants", planned}}}});
}

json status_of(const StudyFolder& folder, const std::vector<std::string>& more = {}) {
  const ProgramResult shown = succeeded(folder.type("status @study.db --json", more));
  return json::parse(shown.output);
}

}  // namespace

TEST_CASE("status names the next participant and has the lines to copy") {
  const StudyFolder folder;
  folder.done("prepare @cloths.json");
  begin_database(folder, "cloths.station");
  const json first = status_of(folder);
  CHECK(first["complete"] == 0);
  REQUIRE(first["next"].size() == 2);
  CHECK(first["next"][0]["command"] == "touchtrial consent " + folder.in("study.db") +
                                           " --participant P01 --version VERSION --details -");
  CHECK(first["next"][1]["command"] == "touchtrial run " + folder.in("cloths.json") +
                                           " --participant P01 --db " + folder.in("study.db"));
  record::PersonalData(record::personal_data_path(folder.path() / "study.db"))
      .put({.participant = "P01",
            .consent_version = "1",
            .consented_utc = "2026-01-02T03:04:05Z",
            .age = {},
            .gender = "",
            .contact = "somebody@example.org"});
  const json consented = status_of(folder);
  REQUIRE(consented["next"].size() == 1);
  CHECK(consented["people"][0]["participant"] == "P01");
  CHECK(consented["people"][0]["state"] == "to come");
  const ProgramResult text = folder.type("status @study.db");
  CHECK(text.output.find("P01:\n    touchtrial run ") != std::string::npos);
  CHECK(text.output.find("example.org") == std::string::npos);
}

TEST_CASE("status of a station of several names the station, and another study is refused") {
  const StudyFolder folder;
  folder.done("prepare @cloths.json");
  folder.done("plan @cloths.json --participants 4 --names left,right");
  begin_database(folder, "cloths.right.station");
  const std::string line = status_of(folder)["next"].back()["command"];
  CHECK(line.find(" " + folder.in("cloths.json") + " ") != std::string::npos);
  CHECK(line.ends_with(" --station right"));
  folder.write_study({{"study", "others"}}, "others.json");
  check_refused(folder.type("status @study.db --study @others.json"), 2,
                {"others.json", "--study"});
}

TEST_CASE("before the first session status lists the consents and has the first lines to copy") {
  const StudyFolder folder;
  check_refused(folder.type("status @study.db"), 1, {"study.db", "--study"});
  folder.done("prepare @cloths.json");
  const json first = status_of(folder);
  CHECK(first["study"] == "cloths");
  CHECK(first["state"] == "collecting");
  CHECK(first["people"].empty());
  CHECK(first["left"].size() == 1);
  REQUIRE(first["next"].size() == 2);
  CHECK(first["next"][1]["command"] == "touchtrial run " + folder.in("cloths.json") +
                                           " --participant P01 --db " + folder.in("study.db"));
  folder.done("consent @study.db --participant P01 --version 2026-03");
  const json consented = status_of(folder);
  CHECK(consented["people"][0]["participant"] == "P01");
  CHECK(consented["people"][0]["consent"] == "2026-03");
  REQUIRE(consented["next"].size() == 1);
  CHECK(names(consented["next"][0]["what"], "P01"));
  CHECK_FALSE(fs::exists(folder.path() / "study.db"));
}

TEST_CASE("a pilot is not counted against the plan") {
  const StudyFolder folder;
  write_visits(folder, 8);
  folder.done("prepare @cloths.json");
  begin_database(folder, "cloths.station", true);
  add_session(folder, "P01", 1, 1, std::chrono::hours(1));
  const json status = status_of(folder);
  CHECK(status["planned"].is_null());
  CHECK(status["left"].dump().find("planned") == std::string::npos);
}

TEST_CASE("status proposes the visit that is due, and names it in the line to copy") {
  const StudyFolder folder;
  write_visits(folder, 2);
  folder.done("prepare @cloths.json");
  begin_database(folder, "cloths.station");
  add_session(folder, "P01", 1, 1, std::chrono::hours(24));
  const json early = status_of(folder);
  CHECK(early["visits"] == 2);
  CHECK(early["complete"] == 0);
  CHECK(early["people"][0]["visit"] == 1);
  CHECK(early["upcoming_visits"][0]["participant"] == "P01");
  CHECK(early["upcoming_visits"][0]["visit"] == 2);
  CHECK(names(early["next"].back()["what"], "P02"));
  add_session(folder, "P02", 2, 1, std::chrono::hours(8 * 24));
  const json due = status_of(folder);
  CHECK(due["next"].back()["what"] == "visit 2 of P02");
  CHECK(due["next"].back()["command"] == "touchtrial run " + folder.in("cloths.json") +
                                             " --participant P02 --db " + folder.in("study.db") +
                                             " --visit 2 --device falcon");
  add_session(folder, "P02", 2, 2, std::chrono::hours(0));
  const json full = status_of(folder);  // as many as are planned have come
  CHECK(full["complete"] == 1);
  CHECK(full["next"].back()["what"].get<std::string>().starts_with("visit 2 of P01, from 20"));
  const ProgramResult text = folder.type("status @study.db");
  CHECK(text.output.find("2 of 2") != std::string::npos);
  CHECK(names_in_order(text.output, "P01 2 2"));
}

TEST_CASE("the plan of a simulated study comes from the files beside its database") {
  const StudyFolder folder;
  folder.write_study({{"registration", {{"participants", 6}}}});
  succeeded(folder.simulate("study.db", {"--keep-blind"}));
  CHECK(status_of(folder)["planned"] == 6);
}

TEST_CASE("status of merged and of simulated studies has no line to copy") {
  const StudyFolder folder;
  succeeded(folder.simulate("study.db", {"--keep-blind"}));
  const json simulated = status_of(folder);
  CHECK(simulated["stamp"] == "SIMULATED");
  CHECK(simulated["complete"] == 4);
  CHECK(simulated["next"].empty());
  folder.done("merge @study.db -o @all.db");
  const ProgramResult merged = folder.done("status @all.db");
  CHECK(merged.output.find("P004") != std::string::npos);
  CHECK(merged.output.find("touchtrial run") == std::string::npos);
}

}  // namespace touchtrial

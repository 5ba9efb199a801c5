// status: how collection stands, and the next participant's command.
#include "app/study_folder.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/personal_data.hpp"
#include "protocols/store/study_store.hpp"
#include "support/catch.hpp"

#include <chrono>

namespace touchtrial {
namespace {

/// A database of people, without a session, as the first `run` makes it.
void begin_database(const StudyFolder& folder, const std::string& station_file) {
  const design::StationKey key = design::load_station_key(folder.path() / station_file);
  store::StudyCommitment commitment;
  commitment.study = key.study.name;
  commitment.protocol = key.study.protocol_name();
  commitment.study_id = key.study_id;
  commitment.seal = key.seal;
  commitment.configuration = key.configuration;
  commitment.scored_trials = key.study.scored_trials();
  commitment.positions = 3;
  commitment.investigator = key.investigator_signature;
  commitment.station = {
      .name = key.station.name, .key = key.signer().public_half(), .certificate = key.certificate};
  static_cast<void>(store::StudyStore::create(folder.path() / "study.db", commitment,
                                              std::chrono::seconds(1), key.signer()));
}

json status_of(const StudyFolder& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"status", folder.in("study.db"), "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult shown = folder.run(arguments);
  INFO(shown.errors);
  REQUIRE(shown.exit_code == 0);
  return json::parse(shown.output);
}

}  // namespace

TEST_CASE("status names the next participant and has the lines to copy") {
  const StudyFolder folder;
  REQUIRE(folder.run({"prepare", folder.in("cloths.json")}).exit_code == 0);
  begin_database(folder, "cloths.station");
  const json first = status_of(folder);
  CHECK(first["complete"] == 0);
  REQUIRE(first["next"].size() == 2);
  CHECK(first["next"][0]["command"] == "touchtrial consent " + folder.in("study.db") +
                                           " --participant P01 --version VERSION --details -");
  CHECK(first["next"][1]["command"] == "touchtrial run " + folder.in("cloths.json") +
                                           " --participant P01 --db " + folder.in("study.db"));
  store::PersonalData(store::personal_data_path(folder.path() / "study.db"))
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
  const ProgramResult text = folder.run({"status", folder.in("study.db")});
  CHECK(text.output.find("session of P01:\n    touchtrial run ") != std::string::npos);
  CHECK(text.output.find("example.org") == std::string::npos);
}

TEST_CASE("status of a station of several names the station, and another study is refused") {
  const StudyFolder folder;
  REQUIRE(folder.run({"prepare", folder.in("cloths.json")}).exit_code == 0);
  REQUIRE(
      folder.run({"plan", folder.in("cloths.json"), "--participants", "4", "--names", "left,right"})
          .exit_code == 0);
  begin_database(folder, "cloths.right.station");
  const std::string line = status_of(folder)["next"].back()["command"];
  CHECK(line.find(" " + folder.in("cloths.json") + " ") != std::string::npos);
  CHECK(line.ends_with(" --station right"));
  json other = study_of("classification");
  other["study"] = "others";
  replace_file(folder.path() / "others.json", other.dump());
  const ProgramResult refused =
      folder.run({"status", folder.in("study.db"), "--study", folder.in("others.json")});
  CHECK(refused.exit_code == 2);
  CHECK(refused.errors.find("is the study others") != std::string::npos);
}

TEST_CASE("status of merged and of simulated studies has no line to copy") {
  const StudyFolder folder;
  REQUIRE(folder.simulate("study.db", {"--keep-blind"}).exit_code == 0);
  const json simulated = status_of(folder);
  CHECK(simulated["stamp"] == "SIMULATED");
  CHECK(simulated["complete"] == 4);
  CHECK(simulated["next"].empty());
  REQUIRE(folder.run({"merge", folder.in("study.db"), "-o", folder.in("all.db")}).exit_code == 0);
  const ProgramResult merged = folder.run({"status", folder.in("all.db")});
  INFO(merged.errors);
  CHECK(merged.exit_code == 0);
  CHECK(merged.output.find("P004") != std::string::npos);
  CHECK(merged.output.find("touchtrial run") == std::string::npos);
}

}  // namespace touchtrial

// Sessions with a simulated participant, run as an experimenter runs them.
#include "app/study_folder.hpp"
#include "protocols/store/study_store.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"

#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::store;
using touchtrial::testing::ChildProcess;

namespace {

std::vector<std::string> run_arguments(const StudyFolder& study, const std::string& participant,
                                       const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {
      "run",       study.in("cloths.json"), "--participant", participant, "--db", study.in("db"),
      "--subject", study.in("quick.json"),  "--headless"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

ProgramResult run(const StudyFolder& study, const std::string& participant,
                  const std::vector<std::string>& more = {}) {
  return study.run(run_arguments(study, participant, more));
}

/// A session in real time that gets a signal after its first acknowledged response.
struct Interrupted {
  Interrupted(const StudyFolder& study, const std::string& participant, int signal) {
    std::vector<std::string> command = run_arguments(study, participant, {"--real-time"});
    command.insert(command.begin(), TOUCHTRIAL_PROGRAM);
    ChildProcess program(command, {});
    const bool responded = program.says("trial 1 acknowledged\n");
    program.send_signal(signal);
    exit_code = program.finish();
    output = program.output();
    INFO(output);
    REQUIRE(responded);
  }

  int exit_code = 0;   ///< -1 if the signal killed it
  std::string output;  ///< including errors
};

int acknowledged(const std::string& output) {
  int count = 0;
  for (std::size_t at = output.find(" acknowledged\n"); at != std::string::npos;
       at = output.find(" acknowledged\n", at + 1)) {
    ++count;
  }
  return count;
}

/// Checks that every trial is answered once, that all classes are equally frequent, and that the
/// chain is whole.
void check_balanced(const StudyFolder& study, int participants) {
  const ProgramResult verified = study.run({"verify", study.in("db")});
  INFO(verified.output << verified.errors);
  CHECK(verified.exit_code == 0);
  REQUIRE(study.run({"close", study.in("db"), "--yes"}).exit_code == 0);
  REQUIRE(study.run({"unblind", study.in("db"), "--reason", "test", "--yes"}).exit_code == 0);
  const ProgramResult reported = study.run({"report", study.in("db"), "--json"});
  REQUIRE(reported.exit_code == 0);
  const json report = json::parse(reported.output);
  CHECK(report.at("participants") == participants);
  CHECK(report.at("trials") == 6 * participants);
  for (const json& row : report.at("methods").at(0).at("confusion")) {
    int presented = 0;
    for (const json& count : row) presented += count.get<int>();
    CHECK(presented == 2 * participants);
  }
}

}  // namespace

TEST_CASE("run makes the database, acknowledges every response, and is refused a second time") {
  const StudyFolder study;
  const ProgramResult first = run(study, "P01");
  INFO(first.errors);
  REQUIRE(first.exit_code == 0);
  CHECK(acknowledged(first.output) == 6);
  CHECK(first.output.find("complete") != std::string::npos);
  CHECK(first.output.find("SIMULATED") != std::string::npos);
  CHECK(first.output.find("day sheet") == std::string::npos);
  for (const std::string& label : kLabels) {
    CHECK(first.output.find(label) == std::string::npos);
    CHECK(first.errors.find(label) == std::string::npos);
  }
  const ProgramResult again = run(study, "P01", {"--on-existing", "resume"});
  CHECK(again.exit_code == 1);
  CHECK(again.errors.find("another participant") != std::string::npos);
  CHECK(run(study, "P02").exit_code == 0);
  check_balanced(study, 2);
}

TEST_CASE("run asks about an id like another's, and about a number beyond the plan") {
  const StudyFolder study;
  json file = study_of("classification");
  file["registration"] = {{"participants", 8}, {"estimand", "mean-accuracy"}};
  replace_file(study.path() / "cloths.json", file.dump());
  const auto refused = [&](const std::string& participant, const std::vector<std::string>& more,
                           const std::string& part) {
    const ProgramResult result = run(study, participant, more);
    INFO(result.errors);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
    CHECK_THAT(result.errors, holds_text(part) && holds_text("--yes"));
  };
  refused("P02", {"--enrolment", "99999"}, "beyond the 8 participants that the study plans");
  CHECK_FALSE(fs::exists(study.path() / "db"));
  REQUIRE(run(study, "P02", {"--enrolment", "8"}).exit_code == 0);
  for (const char* const id : {"p02", "P2", "P002"}) refused(id, {}, "P02 is known");
  CHECK(run(study, "p02", {"--yes"}).exit_code == 0);
  CHECK(run(study, "P03", {"--enrolment", "9", "--yes"}).exit_code == 0);
  const StudyStore store = StudyStore::open(study.in("db"), StudyStore::Access::read_only);
  std::vector<int> numbers;
  for (const SessionRow& row : store.sessions()) numbers.push_back(row.enrolment);
  CHECK(numbers == std::vector<int>{8, 1, 9});
}

TEST_CASE("a run that is refused leaves nothing, and the corrected command runs") {
  const StudyFolder study;
  const bool is_prepared = GENERATE(true, false);
  if (is_prepared) REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  // A simulated study's pack stays, because the next run can use it.
  static_cast<void>(run(study, "P 01"));
  const auto files = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(study.path())) {
      names.insert(entry.path().filename().string());
    }
    return names;
  };
  const std::set<std::string> before = files();
  CHECK_FALSE(before.contains("db"));
  const auto refused = [&](const std::vector<std::string>& more, const std::string& part) {
    std::vector<std::string> command = {"run",  study.in("cloths.json"), "--participant", "P01",
                                        "--db", study.in("db")};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramResult result = study.run(command);
    INFO(result.errors);
    CHECK(result.exit_code != 0);
    CHECK(line_count(result.errors) >= 1);
    CHECK_THAT(result.errors, !holds_text("lies at this station"));  // only a session records it
    CHECK_THAT(result.errors, holds_text(part));
    CHECK(files() == before);
  };
  refused({"--subject", study.in("nobody.json"), "--headless"}, "nobody.json");
  if (is_prepared) {
    refused({"--device", "mouse"}, "give --pilot");
    // There are never so many monitors, nor any where there is no display.
    refused({"--device", "mouse", "--pilot", "--monitor", "16", "--no-sound"}, "window: ");
    refused({"--device", "simulated", "--no-sound"}, "is not a terminal");
  }
  CHECK(run(study, "P01").exit_code == 0);
}

TEST_CASE("a session on a device with force needs an acceptance of that very device") {
  const StudyFolder study;
  REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  replace_file(study.path() / "devices.json",
               json{{"dhd", {{"library", TOUCHTRIAL_FAKE_DHD}}}}.dump());
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {"run",
                                        study.in("cloths.json"),
                                        "--participant",
                                        "P01",
                                        "--db",
                                        study.in("db"),
                                        "--device",
                                        "dhd",
                                        "--no-sound",
                                        "--settings",
                                        study.in("devices.json")};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramResult result = study.run(command);
    CHECK(result.exit_code != 0);
    CHECK_FALSE(fs::exists(study.path() / "db"));
    return result.errors;
  };
  for (const bool is_pilot : {false, true}) {
    const std::vector<std::string> kind =
        is_pilot ? std::vector<std::string>{"--pilot"} : std::vector<std::string>{};
    CHECK_THAT(refused(kind),
               holds_text("touchtrial device accept dhd") && holds_text("--allow-unverified"));
  }
  REQUIRE(study
              .run({"device", "accept", "--emulate", "omega_3", "--certificate",
                    study.in("rehearsed.json")})
              .exit_code == 0);
  CHECK_THAT(refused({"--certificate", study.in("rehearsed.json")}),
             holds_text("proves no device"));
  // Only the terminal is missing then, whether or not the machine allows real time.
  CHECK_THAT(refused({"--allow-unverified", "--allow-late"}),
             holds_text("UNVERIFIED DEVICE") && holds_text("is not a terminal"));
}

TEST_CASE("a database in a folder that is not there is refused before anything else") {
  const StudyFolder study;
  const ProgramResult refused =
      study.run({"run", study.in("cloths.json"), "--participant", "P01", "--db",
                 study.in("nowhere/db"), "--subject", study.in("quick.json"), "--headless"});
  CHECK(refused.exit_code != 0);
  CHECK_THAT(refused.errors, holds_text("there is no folder for it"));
}

TEST_CASE("stations use their own numbers of a plan, and a replacement uses its predecessor's") {
  const StudyFolder study;
  const auto plan = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"plan", study.in("cloths.json"), "--participants"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return study.run(arguments);
  };
  const ProgramResult unprepared = plan({"4", "--names", "attic,cellar"});
  CHECK(unprepared.exit_code == 1);
  CHECK_THAT(unprepared.errors, holds_text("cloths.key: there is no key"));
  REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  REQUIRE(plan({"4", "--names", "attic,cellar"}).exit_code == 0);
  const ProgramResult again = plan({"6", "--names", "attic,cellar"});
  CHECK(again.exit_code == 2);
  CHECK_THAT(again.errors, holds_text("--extend"));

  const ProgramResult nowhere = run(study, "P01");
  CHECK(nowhere.exit_code == 2);
  CHECK_THAT(nowhere.errors, holds_text("cloths.station") && holds_text("--station"));
  const ProgramResult unknown = run(study, "P01", {"--station", "roof"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.errors, holds_text("cloths.roof.station"));

  REQUIRE(run(study, "P01", {"--station", "cellar"}).exit_code == 0);
  const ProgramResult elsewhere = run(study, "P02", {"--station", "attic"});
  CHECK(elsewhere.exit_code == 1);
  CHECK_THAT(elsewhere.errors, holds_text("is the database of station cellar"));
  REQUIRE(run(study, "P02", {"--station", "cellar"}).exit_code == 0);
  const ProgramResult full = run(study, "P03", {"--station", "cellar"});
  CHECK(full.exit_code == 2);
  CHECK_THAT(full.errors, holds_text("numbers of station cellar are taken"));
  REQUIRE(plan({"6", "--extend"}).exit_code == 0);
  REQUIRE(run(study, "P03", {"--station", "cellar"}).exit_code == 0);
  REQUIRE(study.run({"exclude", study.in("db"), "--participant", "P01", "--reason", "test"})
              .exit_code == 0);
  REQUIRE(study
              .run({"replace", study.in("db"), "--participant", "P01", "--with", "P04", "--reason",
                    "test"})
              .exit_code == 0);
  REQUIRE(run(study, "P04", {"--station", "cellar"}).exit_code == 0);

  const StudyStore store = StudyStore::open(study.in("db"), StudyStore::Access::read_only);
  std::vector<int> numbers;
  for (const SessionRow& row : store.sessions()) numbers.push_back(row.enrolment);
  CHECK(numbers == std::vector<int>{3, 4, 6, 3});
}

TEST_CASE("a killed session resumes after the acknowledged responses") {
  const StudyFolder study;
  const Interrupted killed(study, "P01", SIGKILL);
  CHECK(killed.exit_code == -1);
  const int before = acknowledged(killed.output);
  CHECK(before >= 1);
  CHECK(before < 6);
  const ProgramResult refused = run(study, "P01");
  CHECK(refused.exit_code == 1);
  CHECK(refused.errors.find("--on-existing resume") != std::string::npos);
  const ProgramResult resumed = run(study, "P01", {"--on-existing", "resume"});
  INFO(resumed.errors);
  CHECK(resumed.exit_code == 0);
  // The last response may be durable although its acknowledgement was not read.
  CHECK(before + acknowledged(resumed.output) >= 5);
  CHECK(before + acknowledged(resumed.output) <= 6);
  check_balanced(study, 1);
}

TEST_CASE("a session that a signal ends stays open, says so, and can be resumed") {
  const StudyFolder study;
  const Interrupted stopped(study, "P01", SIGTERM);
  CHECK(stopped.exit_code == 128 + SIGTERM);
  CHECK(stopped.output.find("SIGTERM") != std::string::npos);
  CHECK(stopped.output.find("left open") != std::string::npos);
  REQUIRE(run(study, "P01", {"--on-existing", "resume"}).exit_code == 0);
  check_balanced(study, 1);
}

TEST_CASE("an unfinished session can be restarted, and the first one does not count") {
  const StudyFolder study;
  REQUIRE(Interrupted(study, "P01", SIGKILL).exit_code == -1);
  const ProgramResult restarted = run(study, "P01", {"--on-existing", "restart"});
  INFO(restarted.errors);
  CHECK(restarted.exit_code == 0);
  CHECK(acknowledged(restarted.output) == 6);
  check_balanced(study, 1);
}

TEST_CASE("a mistyped --on-existing names the words that there are") {
  const StudyFolder study;
  const ProgramResult refused = run(study, "P01", {"--on-existing", "resum"});
  CHECK(refused.exit_code == 2);
  CHECK(line_count(refused.errors) == 1);
  CHECK(refused.errors.find("--on-existing: 'resum' is unknown; give refuse, resume or restart") !=
        std::string::npos);
}

TEST_CASE("pilot sessions and changed studies are refused") {
  const StudyFolder study;
  REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  REQUIRE(run(study, "P01").exit_code == 0);
  const ProgramResult pilot = run(study, "P02", {"--pilot"});
  CHECK(pilot.exit_code == 1);
  CHECK(pilot.errors.find("pilot") != std::string::npos);

  json changed = study_of("classification");
  changed["trials"]["repeats"] = 3;
  replace_file(study.path() / "cloths.json", changed.dump());
  const ProgramResult other = run(study, "P02");
  CHECK(other.exit_code == 2);
  CHECK(other.errors.find("prepare") != std::string::npos);
}

TEST_CASE("closing a study names the sessions that can no longer be continued") {
  const StudyFolder study;
  REQUIRE(Interrupted(study, "P01", SIGKILL).exit_code == -1);
  REQUIRE(run(study, "P02").exit_code == 0);
  const ProgramResult closed = study.run({"close", study.in("db"), "--yes"});
  INFO(closed.errors);
  CHECK(closed.exit_code == 0);
  CHECK(line_count(closed.errors) == 1);
  CHECK(closed.errors.find("can no longer be continued: P01") != std::string::npos);
  CHECK(closed.errors.find("P02") == std::string::npos);
  const ProgramResult refused = run(study, "P01", {"--on-existing", "resume"});
  CHECK(refused.exit_code == 1);
  CHECK(refused.errors.find("closed") != std::string::npos);
  CHECK(study.run({"verify", study.in("db")}).exit_code == 0);
}

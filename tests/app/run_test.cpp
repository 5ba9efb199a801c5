// Sessions with a simulated participant, run as an experimenter runs them.
#include "app/study_folder.hpp"
#include "record/study_store.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"

#include <csignal>
#include <set>

using namespace touchtrial;
using namespace touchtrial::record;
using touchtrial::testing::ChildProcess;

namespace {

std::vector<std::string> run_arguments(const StudyFolder& study, const std::string& participant,
                                       const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {
      "run",  study.in("cloths.json"), "--participant", participant,
      "--db", study.in("db"),          "--subject",     study.in("quick.json")};
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
  study.done("verify @db");
  study.done("close @db --yes");
  study.done("unblind @db --reason test --yes");
  const json report = study.printed("report @db --json");
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
  const ProgramResult first = succeeded(run(study, "P01", {"--headless"}));
  CHECK(acknowledged(first.output) == 6);
  CHECK(first.output.find("complete") != std::string::npos);
  CHECK(first.output.find("SIMULATED") != std::string::npos);
  CHECK(first.output.find("day sheet") == std::string::npos);
  for (const std::string& label : kLabels) {
    CHECK(first.output.find(label) == std::string::npos);
    CHECK(first.errors.find(label) == std::string::npos);
  }
  check_refused(run(study, "P01", {"--on-existing", "resume"}), 1, {"P01", "session 1"});
  succeeded(run(study, "P02"));
  check_balanced(study, 2);
}

TEST_CASE("run asks about an id like another's, and about a number beyond the plan") {
  const StudyFolder study;
  study.write_study({{"registration", {{"participants", 8}, {"estimand", "mean-accuracy"}}}});
  const auto refused = [&](const std::string& participant, const std::vector<std::string>& more,
                           const std::string& part) {
    const ProgramResult result = run(study, participant, more);
    INFO(result.errors);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
    CHECK_THAT(result.errors, holds_text(part) && holds_text("--yes"));
  };
  refused("P02", {"--enrolment", "99999"}, "8");
  CHECK_FALSE(fs::exists(study.path() / "db"));
  succeeded(run(study, "P02", {"--enrolment", "8"}));
  for (const char* const id : {"p02", "P2", "P002"}) refused(id, {}, "P02");
  succeeded(run(study, "p02", {"--yes"}));
  succeeded(run(study, "P03", {"--enrolment", "9", "--yes"}));
  const StudyStore store = StudyStore::open(study.in("db"), StudyStore::Access::read_only);
  std::vector<int> numbers;
  for (const SessionRow& row : store.sessions()) numbers.push_back(row.enrolment);
  CHECK(numbers == std::vector<int>{8, 1, 9});
}

TEST_CASE("a run that is refused leaves nothing, and the corrected command runs") {
  const StudyFolder study;
  const bool is_prepared = GENERATE(true, false);
  if (is_prepared) study.done("prepare @cloths.json");
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
    const ProgramResult result = study.type("run @cloths.json --participant P01 --db @db", more);
    INFO(result.errors);
    CHECK(result.exit_code != 0);
    CHECK(line_count(result.errors) >= 1);
    CHECK_THAT(result.errors, !holds_text("is at this station"));  // only a session records it
    CHECK_THAT(result.errors, holds_text(part));
    CHECK(files() == before);
  };
  refused({"--subject", study.in("nobody.json")}, "nobody.json");
  if (is_prepared) {
    refused({"--device", "mouse"}, "--pilot");
    // There are never so many monitors, nor any where there is no display.
    refused({"--device", "mouse", "--pilot", "--monitor", "16", "--no-sound"}, "window: ");
    refused({"--device", "simulated", "--no-sound"}, "touchtrial");
  }
  succeeded(run(study, "P01"));
}

TEST_CASE("a session on a device with force needs an acceptance of that very device") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  replace_file(study.path() / "devices.json",
               json{{"dhd", {{"library", TOUCHTRIAL_FAKE_DHD}}}}.dump());
  const auto refused = [&](const std::vector<std::string>& more) {
    const ProgramResult result = study.type(
        "run @cloths.json --participant P01 --db @db --device dhd --no-sound --settings "
        "@devices.json",
        more);
    CHECK(result.exit_code != 0);
    CHECK_FALSE(fs::exists(study.path() / "db"));
    return result.errors;
  };
  for (const bool is_pilot : {false, true}) {
    const std::vector<std::string> kind =
        is_pilot ? std::vector<std::string>{"--pilot"} : std::vector<std::string>{};
    CHECK_THAT(refused(kind), holds_text("device accept dhd") && holds_text("--allow-unverified"));
  }
  study.done("device accept --emulate omega_3 --certificate @rehearsed.json");
  CHECK_THAT(refused({"--certificate", study.in("rehearsed.json")}), holds_text("omega_3"));
  // Only the terminal is missing then, whether or not the machine allows real time.
  CHECK_THAT(refused({"--allow-unverified", "--allow-late"}),
             holds_text("UNVERIFIED DEVICE") && holds_text("terminal"));
}

TEST_CASE("a database in a folder that is not there is refused before anything else") {
  const StudyFolder study;
  const ProgramResult refused =
      study.type("run @cloths.json --participant P01 --db @nowhere/db --subject @quick.json");
  CHECK(refused.exit_code != 0);
}

TEST_CASE("stations use their own numbers of a plan, and a replacement uses its predecessor's") {
  const StudyFolder study;
  const auto plan = [&](const std::vector<std::string>& more) {
    return study.type("plan @cloths.json --participants", more);
  };
  check_refused(plan({"4", "--names", "attic,cellar"}), 1, {"cloths.key"});
  study.done("prepare @cloths.json");
  succeeded(plan({"4", "--names", "attic,cellar"}));
  check_refused(plan({"6", "--names", "attic,cellar"}), 2, {"--extend"});

  check_refused(run(study, "P01"), 2, {"cloths.station", "--station"});
  check_refused(run(study, "P01", {"--station", "roof"}), 2, {"cloths.roof.station"});

  succeeded(run(study, "P01", {"--station", "cellar"}));
  check_refused(run(study, "P02", {"--station", "attic"}), 1, {"station cellar"});
  succeeded(run(study, "P02", {"--station", "cellar"}));
  check_refused(run(study, "P03", {"--station", "cellar"}), 2, {"cellar", "--extend"});
  succeeded(plan({"6", "--extend"}));
  succeeded(run(study, "P03", {"--station", "cellar"}));
  study.done("exclude @db --participant P01 --reason test");
  study.done("replace @db --participant P01 --with P04 --reason test");
  succeeded(run(study, "P04", {"--station", "cellar"}));

  const StudyStore store = StudyStore::open(study.in("db"), StudyStore::Access::read_only);
  std::vector<int> numbers;
  for (const SessionRow& row : store.sessions()) numbers.push_back(row.enrolment);
  CHECK(numbers == std::vector<int>{3, 4, 6, 3});
}

TEST_CASE("a session that a signal ends stays open, says so, and can be resumed") {
  const StudyFolder study;
  const Interrupted stopped(study, "P01", SIGTERM);
  CHECK(stopped.exit_code == 128 + SIGTERM);
  CHECK(stopped.output.find("SIGTERM") != std::string::npos);
  check_refused(run(study, "P01"), 1, {"--on-existing resume"});
  succeeded(run(study, "P01", {"--on-existing", "resume"}));
  check_balanced(study, 1);
}

TEST_CASE("a mistyped --on-existing names the words that there are") {
  const StudyFolder study;
  check_refused(run(study, "P01", {"--on-existing", "resum"}), 2, {"refuse resume"});
}

TEST_CASE("pilot sessions and changed studies are refused") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  succeeded(run(study, "P01"));
  check_refused(run(study, "P02", {"--pilot"}), 1, {"pilot"});

  study.write_study({{"trials", {{"repeats", 3}}}});
  check_refused(run(study, "P02"), 2, {"prepare"});
}

TEST_CASE("closing a study names the sessions that can no longer be continued") {
  const StudyFolder study;
  REQUIRE(Interrupted(study, "P01", SIGKILL).exit_code == -1);
  succeeded(run(study, "P02"));
  const ProgramResult closed = study.done("close @db --yes");
  CHECK(line_count(closed.errors) == 1);
  CHECK(closed.errors.find("P01") != std::string::npos);
  CHECK(closed.errors.find("P02") == std::string::npos);
  check_refused(run(study, "P01", {"--on-existing", "resume"}), 1, {"closed"});
  study.done("verify @db");
}

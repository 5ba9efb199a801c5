// sync, and merge from a server, run against a real server.
#include "app/study_folder.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/postgres_server.hpp"

#include <csignal>
#include <memory>
#include <thread>

using namespace touchtrial;
using touchtrial::testing::ChildProcess;
using touchtrial::testing::PostgresServer;

namespace {

/// Eight simulated participants at four stations, station1.db to station4.db, and merged.db.
struct FourStations : StudyFolder {
  FourStations() : StudyFolder("comparison") {
    for (int station = 1; station <= 4; ++station) {
      const std::string first = std::to_string(2 * station - 1);
      require(run({"simulate", in("cloths.json"), "--participants", "2", "--first-participant",
                   first, "--seed", "3", "--db", file(station), "--subject", in("quick.json")}));
    }
    require(run({"merge", file(1), file(2), file(3), file(4), "-o", in("merged.db")}));
  }

  static void require(const ProgramResult& result) {
    INFO(result.output << result.errors);
    REQUIRE(result.exit_code == 0);
  }
  [[nodiscard]] std::string file(int station) const {
    return in("station" + std::to_string(station) + ".db");
  }
  [[nodiscard]] std::string key() const { return in("merged.db.key"); }
};

const FourStations& stations() {
  static const FourStations made;
  return made;
}

PostgresServer& shared_server() {
  static PostgresServer server;
  return server;
}

int& databases_made() {
  static int made = 0;
  return made;
}

/// The address of a new, empty database.
std::string new_database(PostgresServer& server) {
  const std::string name = "study" + std::to_string(++databases_made());
  server.make_database(name);
  return server.url(name);
}

ProgramResult sync(const std::string& file, const std::string& url,
                   std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"sync", file, url});
  return stations().run(more);
}

void send_all(const std::string& url) {
  for (int station = 1; station <= 4; ++station) {
    FourStations::require(sync(stations().file(station), url));
  }
}

/// Checks that merging the server gives the merged file, to the byte.
void check_equals_merged(const std::string& url) {
  const std::string fetched = stations().in("fetched.db");
  fs::remove(fetched);
  FourStations::require(stations().run({"merge", url, "-o", fetched}));
  CHECK((content(fetched) == content(stations().in("merged.db"))));
}

}  // namespace

TEST_CASE(
    "bundles of stations, or of their merged file, merge to the same file, which the key opens") {
  const std::string url = new_database(shared_server());
  send_all(url);
  check_equals_merged(url);
  FourStations::require(
      stations().run({"verify", stations().in("fetched.db"), "--key", stations().key()}));
  const std::string other = new_database(shared_server());
  const json summary = json::parse(sync(stations().in("merged.db"), other, {"--json"}).output);
  CHECK(summary.at("stations").size() == 4);
  check_equals_merged(other);
}

TEST_CASE("four stations send at once while programs and server are killed, and nothing is lost") {
  PostgresServer server(PostgresServer::Writes::safe);
  const std::string url = new_database(server);
  RandomStream random(8, "kills of stations and server");
  const auto start = [&](int station) {
    return std::make_unique<ChildProcess>(
        std::vector<std::string>{TOUCHTRIAL_PROGRAM, "sync", stations().file(station), url},
        std::vector<std::string>{});
  };
  for (int round = 0; round < 6; ++round) {
    std::vector<std::unique_ptr<ChildProcess>> programs;
    for (int station = 1; station <= 4; ++station) programs.push_back(start(station));
    // The result must be the same whenever this happens.
    std::this_thread::sleep_for(std::chrono::milliseconds(random.below(250)));
    programs[random.below(4)]->send_signal(SIGKILL);
    if (round % 2 == 1) {
      server.kill();
      server.start();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(random.below(100)));
    for (auto& program : programs) program->send_signal(SIGKILL);
  }
  send_all(url);
  check_equals_merged(url);
  CHECK(server.ask("study" + std::to_string(databases_made()),
                   "SELECT count(*) FROM touchtrial_bundles") ==
        std::vector<std::string>{"12"});  // each station's two sessions, and the end of its chain
}

TEST_CASE("sync prints what it did, or would do") {
  const std::string url = new_database(shared_server());
  const json dry = json::parse(sync(stations().file(2), url, {"--dry-run", "--json"}).output);
  CHECK(dry.at("dry_run") == true);
  CHECK(dry.at("stations").at(0).at("sent").size() == 2);
  const json first = json::parse(sync(stations().file(2), url, {"--json"}).output);
  CHECK(first.at("stations").at(0).at("sent").at(0) == "P003");
  CHECK(first.at("stations").at(0).at("already_there") == 0);
  const ProgramResult again = sync(stations().file(2), url);
  CHECK(names_in_order(again.output, "0 2"));
  CHECK(again.output.find("postgres@") == std::string::npos);
}

TEST_CASE("a tampered file is not sent, and altered rows on a server are not merged") {
  const std::string url = new_database(shared_server());
  const std::string database = "study" + std::to_string(databases_made());
  TempFolder folder;
  const std::string copy = (folder.path() / "copy.db").string();
  fs::copy_file(stations().file(1), copy);
  {
    SQLite::Database raw(copy, SQLite::OPEN_READWRITE);
    fixture::without_triggers(
        raw, [&] { raw.exec("UPDATE traces SET box = x'00' WHERE session = 2 AND trial = 3"); });
  }
  check_refused(sync(copy, url), 3, {"session 2"});
  CHECK(shared_server().ask(database, "SELECT to_regclass('touchtrial_bundles') IS NULL") ==
        std::vector<std::string>{"t"});
  send_all(url);
  shared_server().ask(database,
                      "ALTER TABLE touchtrial_bundles DROP CONSTRAINT arrived_whole; "
                      "UPDATE touchtrial_bundles SET session = '\\x00' WHERE bundle = 2");
  check_refused(stations().run({"merge", url, "-o", stations().in("never.db")}), 3, {"2"});
  CHECK_FALSE(fs::exists(stations().in("never.db")));
}

TEST_CASE("every other command refuses an address, names merge, and repeats no password") {
  const FourStations& study = stations();
  for (const std::string where :
       {"postgresql://anna:geheim@localhost/study", "postgressql://anna:geheim@localhost/study"}) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"sync", study.file(1), where},
             {"merge", where, "-o", study.in("never.db")},
             {"report", where},
             {"status", where},
             {"export", where, "--out", study.in("never")},
             {"close", where},
             {"withdraw", where, "--participant", "P001", "--erase", "--reason", "asked"},
             {"verify", where}}) {
      const bool reads_it = arguments.front() == "sync" || arguments.front() == "merge";
      const ProgramResult result = study.run(arguments);
      INFO(arguments.front() << ": " << result.errors);
      CHECK(result.exit_code == 2);
      CHECK(line_count(result.errors) == 1);
      CHECK((result.output + result.errors).find("geheim") == std::string::npos);
      CHECK((reads_it || result.errors.find("touchtrial merge") != std::string::npos));
    }
  }
}

TEST_CASE("an unreachable server is reported in one line") {
  TempFolder empty;
  const std::string url = "postgresql:///study?host=" + empty.path().string();
  check_refused(sync(stations().file(1), url), 1, {});
  check_refused(stations().run({"merge", url, "-o", stations().in("never.db")}), 1, {});
}

TEST_CASE("a program without the server module starts, and sync names the missing module") {
  TempFolder folder;
  const std::string program = (folder.path() / "touchtrial").string();
  fs::copy_file(TOUCHTRIAL_PROGRAM, program);
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), program);
    ChildProcess process(arguments, {});
    const int code = process.finish();
    return std::pair(code, process.output());
  };
  CHECK(run({"--version"}).first == 0);
  const auto [code, output] = run({"sync", stations().file(1), "postgresql:///study"});
  CHECK(code == 1);
  CHECK(line_count(output) == 1);
  CHECK_THAT(output, holds_text("touchtrial-postgres"));
}

// sync, and the commands that read a study from a server, run against a real server.
#include "app/study_folder.hpp"
#include "core/random.hpp"
#include "protocols/store/store_fixture.hpp"
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

/// The address of a new, empty database.
std::string new_database(PostgresServer& server, const std::string& user = "postgres") {
  static int made = 0;
  const std::string name = "study" + std::to_string(++made);
  server.make_database(name);
  return server.url(name, user);
}

ProgramResult sync(const std::string& file, const std::string& url,
                   std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"sync", file, "--to", url});
  return stations().run(more);
}

void push_all(const std::string& url) {
  for (int station = 1; station <= 4; ++station) {
    FourStations::require(sync(stations().file(station), url));
  }
}

/// All files in a folder, by name.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = content(entry.path());
  }
  return files;
}

std::map<std::string, std::string> exported(const std::string& where, const std::string& format,
                                            const std::vector<std::string>& more = {}) {
  TempFolder folder;
  const std::string out = (folder.path() / "out").string();
  std::vector<std::string> arguments = {"export",   where,  "--key", stations().key(),
                                        "--format", format, "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  FourStations::require(stations().run(arguments));
  return contents(out);
}

void check_same_files(const std::map<std::string, std::string>& a,
                      const std::map<std::string, std::string>& b) {
  REQUIRE(a.size() == b.size());
  for (const auto& [name, text] : a) {
    INFO(name);
    REQUIRE(b.contains(name));
    CHECK((b.at(name) == text));
  }
}

/// Checks that the address and the merged file give the same data.
void check_equals_merged(const std::string& url) {
  const std::string merged = stations().in("merged.db");
  const ProgramResult from_file =
      stations().run({"report", merged, "--key", stations().key(), "--json"});
  const ProgramResult from_server =
      stations().run({"report", url, "--key", stations().key(), "--json"});
  FourStations::require(from_file);
  FourStations::require(from_server);
  CHECK((from_server.output == from_file.output));
  CHECK(json::parse(from_server.output).at("participants") == 8);
  for (const char* const format : {"csv", "json"}) {
    check_same_files(exported(url, format), exported(merged, format));
  }
  const ProgramResult verified =
      stations().run({"verify", url, "--key", stations().key(), "--json"});
  FourStations::require(verified);
  CHECK(json::parse(verified.output).at("complete") == true);
}

}  // namespace

TEST_CASE("a study that four stations pushed equals their merged file") {
  const std::string url = new_database(shared_server());
  push_all(url);
  check_equals_merged(url);
  const std::string archive = stations().in("archive.db");
  FourStations::require(stations().run({"merge", url, "-o", archive}));
  FourStations::require(stations().run({"verify", archive, "--key", stations().key()}));
  check_same_files(exported(archive, "csv"), exported(stations().in("merged.db"), "csv"));
}

TEST_CASE("four stations push at once while programs and server are killed, and nothing is lost") {
  PostgresServer server(PostgresServer::Writes::safe);
  const std::string url = new_database(server);
  RandomStream random(8, "kills of stations and server");
  const auto start = [&](int station) {
    return std::make_unique<ChildProcess>(
        std::vector<std::string>{TOUCHTRIAL_PROGRAM, "sync", stations().file(station), "--to", url},
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
  std::vector<std::unique_ptr<ChildProcess>> programs;
  for (int station = 1; station <= 4; ++station) programs.push_back(start(station));
  server.kill();
  server.start();
  for (auto& program : programs) static_cast<void>(program->finish());
  push_all(url);  // those whose first connection fell into the kill
  check_equals_merged(url);
}

TEST_CASE("sync says what it did, what it would do, and what is unbalanced") {
  const std::string url = new_database(shared_server());
  const json dry = json::parse(sync(stations().file(2), url, {"--dry-run", "--json"}).output);
  CHECK(dry.at("dry_run") == true);
  CHECK(dry.at("stations").at(0).at("pushed").size() == 2);
  CHECK(dry.at("stations").at(0).at("station") == 0);
  const json first = json::parse(sync(stations().file(2), url, {"--json"}).output);
  CHECK(first.at("stations").at(0).at("station") == 1);
  CHECK(first.at("stations").at(0).at("pushed").at(0).at("participant") == "P003");
  CHECK(first.at("balance").at("stations").at("1") == 2);
  CHECK(first.at("balance").at("gaps") == json({1, 2}));
  const ProgramResult again = sync(stations().file(2), url);
  CHECK_THAT(again.output,
             holds_text("station2.db: 0 sessions pushed, 2 there before (station 1)"));
  CHECK_THAT(again.output, holds_text("imbalance: enrolment numbers"));
  CHECK(again.output.find("postgres@") == std::string::npos);
}

TEST_CASE("a merged file is pushed station by station") {
  const std::string url = new_database(shared_server());
  const json summary = json::parse(sync(stations().in("merged.db"), url, {"--json"}).output);
  CHECK(summary.at("stations").size() == 4);
  CHECK(sync(stations().file(3), url).output.find("0 sessions pushed, 2 there before") !=
        std::string::npos);
  check_equals_merged(url);
}

TEST_CASE("a file that was tampered with is not pushed") {
  const std::string url = new_database(shared_server());
  TempFolder folder;
  const std::string copy = (folder.path() / "copy.db").string();
  fs::copy_file(stations().file(1), copy);
  {
    SQLite::Database raw(copy, SQLite::OPEN_READWRITE);
    fixture::without_triggers(
        raw, [&] { raw.exec("UPDATE traces SET box = x'00' WHERE session = 2 AND trial = 3"); });
  }
  check_refused(sync(copy, url), 3, {"session 2"});
  CHECK(shared_server().ask(url.substr(14, url.find('?') - 14),
                            "SELECT count(*) FROM pg_tables WHERE schemaname = 'public'") ==
        std::vector<std::string>{"0"});
}

TEST_CASE("every reader refuses data that were altered on the server, with exit code 3") {
  const std::string url = new_database(shared_server());
  push_all(url);
  const std::string database = url.substr(14, url.find('?') - 14);
  shared_server().ask(database,
                      "SET session_replication_role = replica; "
                      "UPDATE events SET body = replace(body, '1', '2') WHERE session = 100001 AND "
                      "kind = 'answered'");
  for (const char* const command : {"report", "export"}) {
    std::vector<std::string> arguments = {command, url, "--key", stations().key()};
    if (std::string(command) == "export") {
      arguments.insert(arguments.end(), {"--out", stations().in("never")});
    }
    check_refused(stations().run(arguments), 3, {"station 2 (station2.db): session 1"});
  }
  const ProgramResult verified = stations().run({"verify", url, "--key", stations().key()});
  CHECK(verified.exit_code == 3);
  CHECK_THAT(verified.output, holds_text("station 2 (station2.db): session 1"));
  CHECK_FALSE(fs::exists(stations().in("never")));
}

TEST_CASE("passwords in addresses are refused by every command, and printed by none") {
  const FourStations& study = stations();
  for (const std::string where :
       {"postgresql://anna:geheim@localhost/study", "postgressql://anna:geheim@localhost/study"}) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"sync", study.file(1), "--to", where},
             {"report", where},
             {"report", where, "--cues", "yes"},
             {"export", where, "--out", study.in("never")},
             {"merge", where, "-o", study.in("never.db")},
             {"close", where},
             {"withdraw", where, "--participant", "P001", "--erase", "--reason", "asked"},
             {"verify", where}}) {
      const ProgramResult result = study.run(arguments);
      INFO(arguments.front() << ": " << result.errors);
      CHECK(result.exit_code != 0);
      CHECK(line_count(result.errors) == 1);
      CHECK((result.output + result.errors).find("geheim") == std::string::npos);
    }
  }
}

TEST_CASE("a page made from a server names neither user nor password") {
  const std::string url = new_database(shared_server());
  push_all(url);
  shared_server().ask("postgres", "CREATE ROLE hildegard LOGIN SUPERUSER");
  const std::string as_user = url.substr(0, url.find("&user=")) + "&user=hildegard";
  const std::string out = stations().in("page");
  FourStations::require(
      stations().run({"report", as_user, "--key", stations().key(), "--out", out}));
  for (const auto& [name, text] : contents(out)) {
    INFO(name);
    CHECK(text.find("hildegard") == std::string::npos);
  }
  check_refused(stations().run({"report", as_user}), 1, {"name the study's key with --key"});
}

TEST_CASE("an unreachable server is reported in one line") {
  TempFolder empty;
  const std::string url = "postgresql:///study?host=" + empty.path().string();
  check_refused(sync(stations().file(1), url), 1, {"cannot be reached"});
  check_refused(stations().run({"report", url}), 1, {"cannot be reached"});
  check_refused(stations().run({"verify", url}), 1, {"cannot be reached"});
}

// What other programs do to the database of a session while the program runs it in real time.
#include "app/study_folder.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"

#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

namespace touchtrial {
namespace {

struct RunningSession : StudyFolder {
  [[nodiscard]] std::vector<std::string> command() const {
    return {TOUCHTRIAL_PROGRAM, "run",       in("cloths.json"), "--participant", "P01", "--db",
            in("study.db"),     "--subject", in("quick.json"),  "--real-time"};
  }
};

}  // namespace

TEST_CASE("a session waits while another program has its database locked, and records it") {
  const RunningSession study;
  testing::ChildProcess program(study.command(), {});
  REQUIRE(program.says("trial 1 acknowledged"));
  {
    SQLite::Database viewer(study.in("study.db"), SQLite::OPEN_READWRITE, 60'000);
    viewer.exec("BEGIN IMMEDIATE");
    REQUIRE(program.says("the session waits"));
    viewer.exec("ROLLBACK");
  }
  const int code = program.finish();
  INFO(program.output());
  CHECK(code == 0);
  study.done("close @study.db --yes");
  study.done("unblind @study.db --yes --reason done");
  study.done("export @study.db --format csv --out @out");
  CHECK(content(study.path() / "out/incidents.csv").find("database-locked") != std::string::npos);
  study.done("verify @study.db");
}

TEST_CASE("a session whose database is replaced ends, and saves what it recorded") {
  const RunningSession study;
  const fs::path database = study.in("study.db");
  testing::ChildProcess program(study.command(), {});
  REQUIRE(program.says("trial 1 acknowledged"));
  fs::copy_file(database, study.in("other.db"));
  fs::rename(study.in("other.db"), database);
  const int code = program.finish();
  INFO(program.output());
  CHECK(code == 1);
  CHECK_THAT(program.output(), holds_text("study-rescued-1.db"));
  CHECK_THAT(study.done("status @study-rescued-1.db").output, holds_text("P01"));
}

}  // namespace touchtrial

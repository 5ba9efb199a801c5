#include "protocols/store/first_version.hpp"
#include "protocols/store/schema.hpp"
#include "support/catch.hpp"

#include <fstream>
#include <sstream>

using namespace touchtrial;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

using Access = StudyStore::Access;

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Two sessions, one of them withdrawn, in a database of the first schema.
struct OldStudy {
  OldStudy() {
    study.store->withdraw(2, kUtc, "asked to");
    sessions = study.store->sessions();
    trials = study.store->trials();
    study.store.reset();
    write_first_version(path, study.path);
  }

  StoredFixture study{2};
  std::filesystem::path path = study.folder.path() / "old.db";
  std::vector<SessionRow> sessions;
  std::vector<TrialRow> trials;
};

}  // namespace

TEST_CASE("a database of the first schema is brought forward with all that it holds") {
  OldStudy old;
  {
    StudyStore store = StudyStore::open(old.path, Access::read_write);
    REQUIRE(store.sessions() == old.sessions);
    REQUIRE(store.trials() == old.trials);
    REQUIRE_FALSE(store.first_fault());
    store.rebuild_derived();
    REQUIRE(store.sessions() == old.sessions);
    REQUIRE(store.trials() == old.trials);
    add(store, 3);
    REQUIRE_FALSE(store.first_fault());
  }
  REQUIRE(StudyStore::open(old.path, Access::read_only).sessions().size() == 3);
  SQLite::Database raw(old.path.string());
  REQUIRE(raw.execAndGet("PRAGMA integrity_check").getString() == "ok");
  REQUIRE_FALSE(SQLite::Statement(raw, "PRAGMA foreign_key_check").executeStep());
  REQUIRE(raw.execAndGet("SELECT count(*) FROM sqlite_schema WHERE name LIKE 'old%'").getInt() ==
          0);
}

TEST_CASE("the schema of a database that was brought forward is that of a new one") {
  OldStudy old;
  { const StudyStore store = StudyStore::open(old.path, Access::read_write); }
  const auto schema_of = [](const std::filesystem::path& path) {
    SQLite::Database raw(path.string());
    SQLite::Statement query(raw, "SELECT type, name, sql FROM sqlite_schema ORDER BY type, name");
    std::string text;
    while (query.executeStep()) {
      text += query.getColumn(0).getString() + ' ' + query.getColumn(1).getString() + ' ' +
              query.getColumn(2).getString() + '\n';
    }
    return text;
  };
  REQUIRE(schema_of(old.path) == schema_of(old.study.path));
}

TEST_CASE("before a database is brought forward a copy of it is laid beside it") {
  OldStudy old;
  { const StudyStore store = StudyStore::open(old.path, Access::read_write); }
  SQLite::Database copy(backup_path(old.path, 1).string());
  REQUIRE(copy.execAndGet("PRAGMA user_version").getInt() == 1);
  REQUIRE(copy.execAndGet("SELECT count(*) FROM trials").getInt() == 6);
  REQUIRE_FALSE(SQLite::Statement(copy, "SELECT * FROM sessions").getColumnCount() == 10);
}

TEST_CASE("an older database is not changed by reading it, and the refusal says what to do") {
  OldStudy old;
  const std::string before = content_of(old.path);
  REQUIRE(contains(refusal_of([&] { return StudyStore::open(old.path, Access::read_only); }),
                   "is of an older schema; `touchtrial migrate"));
  REQUIRE(content_of(old.path) == before);
  REQUIRE_FALSE(std::filesystem::exists(backup_path(old.path, 1)));
}

TEST_CASE("a copy that is there already is never written over") {
  OldStudy old;
  std::ofstream(backup_path(old.path, 1)) << "somebody's";
  const std::string before = content_of(old.path);
  REQUIRE(contains(refusal_of([&] { return StudyStore::open(old.path, Access::read_write); }),
                   ".v1.backup exists already; move that away"));
  REQUIRE(content_of(old.path) == before);
  REQUIRE(content_of(backup_path(old.path, 1)) == "somebody's");
}

TEST_CASE("what was altered in an older database is still found after it is brought forward") {
  OldStudy old;
  {
    SQLite::Database raw(old.path.string(), SQLite::OPEN_READWRITE);
    raw.exec("UPDATE responses SET position = position + 1 WHERE session = 1 AND trial = 1");
  }
  const StudyStore store = StudyStore::open(old.path, Access::read_write);
  REQUIRE(contains(store.first_fault().value().what,
                   "derived table responses disagrees with the events at trial 1"));
}

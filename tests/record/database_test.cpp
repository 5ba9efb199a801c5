#include "core/files.hpp"
#include "record/schema.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <fstream>

#include <sys/stat.h>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

using Access = StudyStore::Access;

void write(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// The message with which a file is refused. The file must be unchanged, with no new file beside
/// it.
std::string refusal_untouched(const std::filesystem::path& path, Access access) {
  const std::string before = text_of(read_file(path));
  const std::string line = refusal_of([&] { return StudyStore::open(path, access); });
  REQUIRE(contains(line, path.string()));
  REQUIRE_FALSE(contains(line, "\n"));
  REQUIRE(text_of(read_file(path)) == before);
  REQUIRE_FALSE(std::filesystem::exists(path.string() + "-wal"));
  REQUIRE_FALSE(std::filesystem::exists(path.string() + "-journal"));
  return line;
}

std::string pragma(const std::filesystem::path& path, const std::string& name) {
  SQLite::Database raw(path.string());
  return raw.execAndGet("PRAGMA " + name).getString();
}

}  // namespace

TEST_CASE("a database is in WAL mode, of our application id and schema version") {
  StoredFixture study(1);
  study.store.reset();
  REQUIRE(pragma(study.path, "journal_mode") == "wal");
  REQUIRE(pragma(study.path, "application_id") == std::to_string(0x5454524c));
  REQUIRE(pragma(study.path, "user_version") == std::to_string(kSchemaVersion));
  REQUIRE(pragma(study.path, "integrity_check") == "ok");
  SQLite::Database raw(study.path.string());
  REQUIRE_FALSE(SQLite::Statement(raw, "PRAGMA foreign_key_check").executeStep());
}

TEST_CASE("a database that was closed is one file") {
  StoredFixture study(2);
  study.store.reset();
  REQUIRE_FALSE(std::filesystem::exists(study.path.string() + "-wal"));
  REQUIRE_FALSE(std::filesystem::exists(study.path.string() + "-shm"));
}

TEST_CASE("reading changes nothing and leaves no file beside the database") {
  StoredFixture study(1);
  study.store.reset();
  const std::string before = text_of(read_file(study.path));
  {
    const StudyStore reader = StudyStore::open(study.path, Access::read_only);
    REQUIRE(reader.trials().size() == 3);
    REQUIRE_FALSE(reader.first_fault());
  }
  REQUIRE(text_of(read_file(study.path)) == before);
  REQUIRE_FALSE(std::filesystem::exists(study.path.string() + "-wal"));
  REQUIRE_FALSE(std::filesystem::exists(study.path.string() + "-shm"));
}

TEST_CASE("a database opened for reading refuses every change") {
  StoredFixture study(1);
  study.store.reset();
  StudyStore reader = StudyStore::open(study.path, Access::read_only);
  REQUIRE(refuses([&] { add(reader, 2); }));
  REQUIRE(refuses([&] { reader.close_study(kUtc); }));
  REQUIRE(refuses([&] { reader.withdraw(1, kUtc, "x"); }));
  REQUIRE(refuses([&] { reader.exclude(1, kUtc, "x"); }));
  REQUIRE(reader.next_session() == 2);
}

TEST_CASE("a database in a folder that cannot be written can be read") {
  StoredFixture study(1);
  study.store.reset();
  const std::filesystem::path odd = study.folder.path() / "50% of #1?";
  std::filesystem::create_directory(odd);
  std::filesystem::rename(study.path, odd / "study.db");
  REQUIRE(::chmod((odd / "study.db").c_str(), 0444) == 0);
  REQUIRE(::chmod(odd.c_str(), 0555) == 0);
  {
    const StudyStore reader = StudyStore::open(odd / "study.db", Access::read_only);
    REQUIRE(reader.trials().size() == 3);
    REQUIRE_FALSE(reader.first_fault());
  }
  REQUIRE(std::distance(std::filesystem::directory_iterator(odd), {}) == 1);
  REQUIRE(::chmod(odd.c_str(), 0755) == 0);
}

TEST_CASE("an existing file is never overwritten") {
  TempFolder folder;
  const auto path = folder.path() / "taken.db";
  write(path, "precious");
  REQUIRE(refuses([&] { return StudyStore::create(path, commitment(), kUtc, investigator()); },
                  path.string()));
  REQUIRE(text_of(read_file(path)) == "precious");
}

TEST_CASE("a database that cannot be made leaves nothing behind") {
  TempFolder folder;
  REQUIRE_THROWS_AS(
      StudyStore::create(folder.path() / "no" / "x.db", commitment(), kUtc, investigator()),
      FileError);
  StudyCommitment odd = commitment();
  odd.study = "\xc3\x28";
  REQUIRE_THROWS_AS(StudyStore::create(folder.path() / "x.db", odd, kUtc, investigator()),
                    StoreError);
  REQUIRE(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a file that is not our database is refused untouched") {
  TempFolder folder;
  const auto path = folder.path() / "file.db";
  for (const Access access : {Access::read_only, Access::read_write}) {
    REQUIRE(
        refuses([&] { return StudyStore::open(folder.path() / "none", access); }, "[no-database]"));
    REQUIRE(
        refuses([&] { return StudyStore::open(folder.path(), access); }, folder.path().string()));
    for (const std::string& content :
         {std::string(), std::string("SQLite format 3"), std::string(5000, 'x')}) {
      write(path, content);
      REQUIRE(names(refusal_untouched(path, access), "[not-a-database]"));
    }
    std::filesystem::remove(path);
    SQLite::Database(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec("CREATE TABLE events(x)");
    REQUIRE(names(refusal_untouched(path, access), "[not-a-database]"));
  }
}

TEST_CASE("a database of another version is refused untouched") {
  StoredFixture study(1);
  study.store.reset();
  for (const int version : {1, kSchemaVersion - 1, kSchemaVersion + 1}) {
    SQLite::Database(study.path.string(), SQLite::OPEN_READWRITE)
        .exec("PRAGMA user_version = " + std::to_string(version));
    for (const Access access : {Access::read_only, Access::read_write}) {
      CHECK(names_in_order(refusal_untouched(study.path, access),
                           std::to_string(version) + " " + std::to_string(kSchemaVersion)));
    }
  }
}

TEST_CASE("a truncated database is refused untouched, wherever it was cut") {
  StoredFixture study(2);
  study.store.reset();
  const std::string whole = text_of(read_file(study.path));
  for (const std::size_t size : {whole.size() - 1, whole.size() - 8192, whole.size() / 2,
                                 std::size_t{8192}, std::size_t{100}}) {
    write(study.path, whole.substr(0, size));
    for (const Access access : {Access::read_only, Access::read_write}) {
      REQUIRE(names(refusal_untouched(study.path, access), "[truncated]"));
    }
  }
}

TEST_CASE("garbage in a database is noticed, or hits unused bytes") {
  StoredFixture study(2);
  const auto trials = study.store->trials();
  study.store.reset();
  const std::string whole = text_of(read_file(study.path));
  RandomStream random(9, "garbage");
  int noticed = 0;
  for (int i = 0; i < 200; ++i) {
    std::string damaged = whole;
    const std::size_t begin = 100 + random.below(damaged.size() - 700);
    for (std::size_t j = 0; j < 600; ++j) damaged[begin + j] = static_cast<char>(random.below(256));
    write(study.path, damaged);
    const std::string line = refusal_of([&] {
      const StudyStore store = StudyStore::open(study.path, Access::read_only);
      if (const auto fault = store.first_fault()) throw StoreError(fault->what);
      REQUIRE(store.trials() == trials);
    });
    REQUIRE_FALSE(contains(line, "\n"));
    if (!line.empty()) ++noticed;
  }
  REQUIRE(noticed > 20);
}

TEST_CASE("a database that another program is writing to is refused with the remedy") {
  StoredFixture study(1);
  SQLite::Database other(study.path.string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  REQUIRE(refuses([&] { study.store->close_study(kUtc); }));
  other.exec("ROLLBACK");
  study.store->close_study(kUtc);
  REQUIRE(study.store->state().closed);
}

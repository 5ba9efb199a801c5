#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <cstdlib>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

/// A closed study of two sessions, made once.
const std::filesystem::path& two_sessions() {
  static StoredFixture study(2);
  study.store.reset();
  return study.path;
}

std::optional<ChainFault> fault_after(const std::string& sql) {
  StoredFixture study(two_sessions());
  tamper(study, sql);
  return study.store->first_fault();
}

/// SQL that flips the lowest bit of the first byte of a text or blob column.
std::string flipped_blob(const std::string& table, const std::string& column,
                         const std::string& where) {
  SQLite::Database raw(two_sessions().string());
  const std::string hex =
      raw.execAndGet("SELECT hex(" + column + ") FROM " + table + " WHERE " + where).getString();
  std::string flipped = hex;
  flipped[1] = static_cast<char>(hex[1] == '0' ? '1' : '0');
  return "UPDATE " + table + " SET " + column + " = x'" + flipped + "' WHERE " + where;
}

std::string flipped_text(const std::string& table, const std::string& column,
                         const std::string& where) {
  return "UPDATE " + table + " SET " + column + " = 'X' || substr(" + column + ", 2) WHERE " +
         where;
}

std::string next_number(const std::string& table, const std::string& column,
                        const std::string& where) {
  return "UPDATE " + table + " SET " + column + " = " + column + " + 1 WHERE " + where;
}

const std::string kFourth = "session = 1 AND sequence = 5";  // trial 1's trace-stored

constexpr const char* kAltered = "[altered-event]";

struct Tampering {
  std::string sql;
  std::string place;       ///< "session/sequence" of the first fault
  std::string words = {};  ///< numbers and the code that the fault names, in order
};

void require_named(const std::vector<Tampering>& tamperings) {
  for (const Tampering& tampering : tamperings) {
    INFO(tampering.sql);
    const auto fault = fault_after(tampering.sql);
    REQUIRE(fault);
    REQUIRE(place_of(*fault) == tampering.place);
    if (!tampering.words.empty()) REQUIRE(names_in_order(fault->what, tampering.words));
  }
}

}  // namespace

TEST_CASE("an altered event is named, whichever of its members was altered") {
  require_named({
      {next_number("events", "at_ns", kFourth), "1/5", kAltered},
      {flipped_blob("events", "sealed", kFourth), "1/5", kAltered},
      {flipped_blob("events", "hash", kFourth), "1/5", kAltered},
      {"UPDATE events SET body = replace(body, 'true', 'false') WHERE " + kFourth, "1/5", kAltered},
      {"UPDATE events SET kind = 'noted' WHERE " + kFourth, "1/5", kAltered},
      {flipped_blob("events", "previous", kFourth), "1/5", "[broken-link]"},
      {flipped_text("events", "kind", kFourth), "1/5", "Xrace-stored"},
      {"UPDATE events SET hash = x'00' WHERE " + kFourth, "1/5"},
      {"UPDATE events SET sequence = 900 WHERE " + kFourth, "1/5", "5 [sequence-gap]"},
      {"UPDATE events SET session = 3 WHERE " + kFourth, "1/5", "5 [sequence-gap]"},
  });
}

TEST_CASE("an altered event of the file's chain is named") {
  for (int sequence = 0; sequence < 5; ++sequence) {
    const std::string where = "session = 0 AND sequence = " + std::to_string(sequence);
    const std::string place = "0/" + std::to_string(sequence);
    require_named({{next_number("events", "at_ns", where), place, kAltered},
                   {flipped_text("events", "body", where), place, kAltered}});
  }
}

TEST_CASE("deleted, swapped and moved events are named, and cut chains held against the file's") {
  const std::string copy_as =
      ", sequence, kind, at_ns, body, sealed, previous, hash, signature, NULL FROM events WHERE "
      "session = 1";
  require_named({
      {"DELETE FROM events WHERE session = 0 AND sequence = 0", "0/0", "0 [sequence-gap]"},
      {"DELETE FROM events WHERE session = 0", "0/0", "[empty-chain]"},
      {"DELETE FROM events WHERE session = 2 AND sequence = 7", "2/7", "7 [sequence-gap]"},
      {"DELETE FROM events WHERE session = 2 AND sequence = 0", "2/0", "0 [sequence-gap]"},
      {"UPDATE events SET sequence = -1 WHERE session = 1 AND sequence = 3;"
       "UPDATE events SET sequence = 3 WHERE session = 1 AND sequence = 4;"
       "UPDATE events SET sequence = 4 WHERE session = 1 AND sequence = -1",
       "1/3", "[broken-link]"},
      {"UPDATE events SET session = 9 WHERE session = 2", "0/3", "2"},
      {"DELETE FROM events WHERE session = 1", "0/1", "1"},
      {"INSERT INTO events SELECT 9" + copy_as, "9/0", "[stray-session]"},
      {"INSERT INTO events SELECT -1" + copy_as, "-1/0", "[other-chain]"},
      {"DELETE FROM events WHERE session = 2 AND kind = 'closed'", "2/13", "2 13 14"},
      {"DELETE FROM events WHERE session = 2 AND sequence > 9", "2/9", "2 9 14"},
      {"DELETE FROM events WHERE session = 0 AND sequence = 4", "2/14", "[unrecorded-end]"},
      {"DELETE FROM events WHERE session = 0 AND sequence >= 3", "2/0", "[stray-session]"},
  });
}

TEST_CASE("another session in the place of a stored one is noticed") {
  StoredFixture study(2);
  StoredFixture other(1);
  other.store.reset();
  other.store.emplace(
      StudyStore::create(other.folder.path() / "b.db", commitment(), kUtc, investigator()));
  SessionOpening how = opening(1);
  how.device = "another";
  other.store->add_session(session_of(1, 3, stroking(20, 0.05), how), wrapped_key_of(1), kUtc);
  other.store.reset();
  tamper(study, "ATTACH '" + (other.folder.path() / "b.db").string() +
                    "' AS b; DELETE FROM events WHERE session = 1;"
                    "INSERT INTO events SELECT * FROM b.events WHERE session = 1");
  const auto fault = study.store->first_fault();
  REQUIRE(fault->session == 1);
  REQUIRE(fault->sequence == 0);
  REQUIRE(names(fault->what, "[other-session]"));
}

TEST_CASE("an altered, missing or added trace or key is named by its trial or session") {
  require_named({
      {flipped_blob("traces", "box", "session = 2 AND trial = 2"), "2/9", "2 [altered-trace]"},
      {"DELETE FROM traces WHERE session = 1 AND trial = 3", "1/13", "3 [missing-trace]"},
      {"DELETE FROM traces WHERE session = 2", "2/5", "1 [missing-trace]"},
      {"UPDATE traces SET trial = 7 WHERE session = 1 AND trial = 2", "1/9", "2 [missing-trace]"},
      {"INSERT INTO traces VALUES(2, 9, x'00')", "2/0", "9 [stray-trace]"},
      {"UPDATE traces SET session = 5 WHERE session = 2 AND trial = 3", "2/13",
       "3 [missing-trace]"},
      {flipped_blob("participant_keys", "wrapped", "session = 2"), "2/0", "[altered-key]"},
      {"DELETE FROM participant_keys WHERE session = 1", "1/0", "[missing-key]"},
      {"INSERT INTO participant_keys VALUES(8, x'00')", "8/0", "[stray-key]"},
      {"INSERT INTO station_keys VALUES(1, x'00')", "1/0", "[stray-copy]"},
      {"INSERT INTO station_keys VALUES(8, x'00')", "8/0", "[stray-copy]"},
  });
  StoredFixture study(1);
  study.store->withdraw(1, kUtc, "asked to");
  tamper(study, "INSERT INTO participant_keys VALUES(1, x'00')");
  const ChainFault kept = study.store->first_fault().value();
  REQUIRE(place_of(kept) == "1/0");
  REQUIRE(names(kept.what, "[kept-key]"));
}

TEST_CASE("a tampered database answers with one line, not with invented data") {
  StoredFixture study(1);
  tamper(study,
         "UPDATE events SET kind = 'gone' WHERE session = 1 AND sequence = 2;"
         "UPDATE events SET body = '{}' WHERE session = 0 AND sequence = 0");
  for (const std::string& line : {refusal_of([&] { return study.store->events(1); }),
                                  refusal_of([&] { return study.store->trials(); }),
                                  refusal_of([&] { return study.store->commitment(); })}) {
    REQUIRE(contains(line, study.path.string()));
  }
}

TEST_CASE("what a chain cannot show: an open session cut at its end") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  recorder.add(seconds(1), EventKind::noted, RemarkBody{.text = "late"});
  tamper(study, "DELETE FROM events WHERE session = 1 AND sequence = 1");
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("an object of the schema that is missing or altered is named") {
  const auto altered = [](const std::string& sql) {
    StoredFixture study(two_sessions());
    {
      SQLite::Database raw(study.path.string(), SQLite::OPEN_READWRITE);
      raw.exec(sql);
    }
    study.store = StudyStore::open(study.path, StudyStore::Access::read_only);
    const auto fault = study.store->first_fault(TraceCheck::skip);
    return fault ? fault->what : std::string();
  };
  REQUIRE(altered("").empty());
  REQUIRE(names_in_order(altered("DROP TRIGGER events_no_delete"), "trigger events_no_delete"));
  REQUIRE(names_in_order(
      altered("DROP TRIGGER traces_no_update; CREATE TRIGGER traces_no_update BEFORE UPDATE ON "
              "traces BEGIN SELECT 1; END"),
      "trigger traces_no_update"));
}

/// Does what a line says from "sqlite3" on as a shell would.
void obey(const std::string& line) {
  const TempFolder folder;
  const std::string words = (folder.path() / "words").string();
  replace_file(folder.path() / "script", "sqlite3() { printf '%s\\0' \"$@\" > '" + words +
                                             "'; }\n" + line.substr(line.find("sqlite3 ")));
  REQUIRE(std::system(("bash '" + (folder.path() / "script").string() + "'").c_str()) == 0);
  const std::string file = text_of(read_file(words));
  const std::size_t end = file.find('\0');
  SQLite::Database(file.substr(0, end), SQLite::OPEN_READWRITE).exec(file.substr(end + 1));
}

TEST_CASE("additions to the schema are reported with the command that removes them, in one line") {
  const auto removed = [](const std::string& sql, const std::string& name) {
    INFO(sql);
    StoredFixture study(two_sessions());
    study.store.reset();
    SQLite::Database(study.path.string(), SQLite::OPEN_READWRITE).exec(sql);
    const auto open = [&] {
      study.store = StudyStore::open(study.path, StudyStore::Access::read_write);
    };
    const std::string line = refusal_of(open);
    CHECK(contains(line, name + " "));
    CHECK(line == one_line(line));
    study.store = StudyStore::open(study.path, StudyStore::Access::read_only);
    CHECK(names(study.store->first_fault(TraceCheck::skip).value().what, "sqlite3"));
    study.store.reset();
    obey(line);
    REQUIRE(refusal_of(open).empty());
    CHECK_FALSE(study.store->first_fault());
  };
  removed("CREATE VIEW results AS SELECT * FROM events", "view results");
  removed("CREATE INDEX quick ON events(kind)", "index quick");
  removed("CREATE TRIGGER greedy BEFORE INSERT ON traces BEGIN SELECT 1; END", "trigger greedy");
  removed("CREATE TABLE notes(x PRIMARY KEY, y UNIQUE); CREATE INDEX of_notes ON notes(y)",
          "of_notes");
  removed("CREATE TABLE counted(x INTEGER PRIMARY KEY AUTOINCREMENT)", "table counted");
  removed("CREATE VIRTUAL TABLE words USING fts5(x)", "words");
  removed("ALTER TABLE traces ADD COLUMN presented TEXT", "table traces");
  removed(R"sql(ALTER TABLE events ADD COLUMN "k""'$(exit 3)" INTEGER AS (session + 1);
             ALTER TABLE participant_keys ADD COLUMN g INTEGER AS (length(wrapped));
             CREATE INDEX by_g ON participant_keys(g))sql",
          "events");
  removed("CREATE TABLE \"'; rm -rf \"\"$HOME\"\" `x` \\ \n\t\x1b[31m !! é\"(x)", "table");
}

TEST_CASE("internal tables of ANALYZE and AUTOINCREMENT are allowed, but fakes of them are not") {
  StoredFixture study(two_sessions());
  study.store.reset();
  const auto opened_after = [&](const std::string& sql) {
    {
      SQLite::Database raw(study.path.string(), SQLite::OPEN_READWRITE);
      raw.exec(sql);
    }
    return refusal_of(
        [&] { static_cast<void>(StudyStore::open(study.path, StudyStore::Access::read_write)); });
  };
  REQUIRE(opened_after("CREATE TABLE t(x INTEGER PRIMARY KEY AUTOINCREMENT); DROP TABLE t; "
                       "ANALYZE; ANALYZE")
              .empty());
  SQLite::Database raw(study.path.string(), SQLite::OPEN_READWRITE);
  REQUIRE(raw.tableExists("sqlite_stat1"));
  REQUIRE(raw.tableExists("sqlite_sequence"));
  study.store = writable(study.path);
  add(*study.store, 3);
  REQUIRE_FALSE(study.store->first_fault());
  study.store.reset();
  raw.exec(
      "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = 'CREATE TABLE "
      "sqlite_stat1(tbl,idx,stat,answers)' WHERE name = 'sqlite_stat1'");
  CHECK(contains(opened_after("SELECT 1"), "sqlite_stat1"));
}

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

/// The fault found after some SQL was run behind the store's back: "session/sequence what".
std::string fault_after(const std::string& sql) {
  StoredFixture study(two_sessions());
  tamper(study, sql);
  const auto fault = study.store->first_fault();
  if (!fault) return "";
  return std::to_string(fault->session) + "/" + std::to_string(fault->sequence) + " " + fault->what;
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

struct Tampering {
  std::string sql;
  std::string fault;  ///< what fault_after gives
};

void require_named(const std::vector<Tampering>& tamperings) {
  for (const auto& [sql, fault] : tamperings) {
    INFO(sql);
    REQUIRE(fault_after(sql) == fault);
  }
}

const std::string kHash = "the hash of the event does not match its content";

}  // namespace

TEST_CASE("an altered event is named, whichever of its members was altered") {
  require_named({
      {next_number("events", "at_ns", kFourth), "1/5 " + kHash},
      {flipped_blob("events", "sealed", kFourth), "1/5 " + kHash},
      {flipped_blob("events", "hash", kFourth), "1/5 " + kHash},
      {"UPDATE events SET body = replace(body, 'true', 'false') WHERE " + kFourth, "1/5 " + kHash},
      {"UPDATE events SET kind = 'noted' WHERE " + kFourth, "1/5 " + kHash},
      {flipped_blob("events", "previous", kFourth),
       "1/5 previous does not match the hash of the event before"},
      {flipped_text("events", "kind", kFourth), "1/5 unknown kind of event 'Xrace-stored'"},
      {"UPDATE events SET hash = x'00' WHERE " + kFourth,
       "1/5 a hash of the event is not 32 bytes long"},
      {"UPDATE events SET sequence = 900 WHERE " + kFourth, "1/5 sequence gap: event 5 is missing"},
      {"UPDATE events SET session = 3 WHERE " + kFourth, "1/5 sequence gap: event 5 is missing"},
  });
}

TEST_CASE("an altered event of the file's chain is named") {
  for (int sequence = 0; sequence < 5; ++sequence) {
    const std::string where = "session = 0 AND sequence = " + std::to_string(sequence);
    const std::string fault = "0/" + std::to_string(sequence) + " " + kHash;
    require_named({{next_number("events", "at_ns", where), fault},
                   {flipped_text("events", "body", where), fault}});
  }
}

TEST_CASE("deleted, swapped and moved events are named, and cut chains held against the file's") {
  const std::string copy_as =
      ", sequence, kind, at_ns, body, sealed, previous, hash, signature, NULL FROM events WHERE "
      "session = 1";
  require_named({
      {"DELETE FROM events WHERE session = 0 AND sequence = 0",
       "0/0 sequence gap: event 0 is missing"},
      {"DELETE FROM events WHERE session = 0", "0/0 the file's chain is empty"},
      {"DELETE FROM events WHERE session = 2 AND sequence = 7",
       "2/7 sequence gap: event 7 is missing"},
      {"DELETE FROM events WHERE session = 2 AND sequence = 0",
       "2/0 sequence gap: event 0 is missing"},
      {"UPDATE events SET sequence = -1 WHERE session = 1 AND sequence = 3;"
       "UPDATE events SET sequence = 3 WHERE session = 1 AND sequence = 4;"
       "UPDATE events SET sequence = 4 WHERE session = 1 AND sequence = -1",
       "1/3 previous does not match the hash of the event before"},
      {"UPDATE events SET session = 9 WHERE session = 2", "0/3 session 2 has no events"},
      {"DELETE FROM events WHERE session = 1", "0/1 session 1 has no events"},
      {"INSERT INTO events SELECT 9" + copy_as, "9/0 the file's chain has no such session"},
      {"INSERT INTO events SELECT -1" + copy_as, "-1/0 the event belongs to another chain"},
      {"DELETE FROM events WHERE session = 2 AND kind = 'closed'",
       "2/13 session 2 ends at event 13, the file's chain states 14"},
      {"DELETE FROM events WHERE session = 2 AND sequence > 9",
       "2/9 session 2 ends at event 9, the file's chain states 14"},
      {"DELETE FROM events WHERE session = 0 AND sequence = 4",
       "2/14 the session is closed, but not on the file's chain"},
      {"DELETE FROM events WHERE session = 0 AND sequence >= 3",
       "2/0 the file's chain has no such session"},
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
  REQUIRE(fault->what == "the session's first event is not the one on the file's chain");
}

TEST_CASE("an altered, missing or added trace or key is named by its trial or session") {
  require_named({
      {flipped_blob("traces", "box", "session = 2 AND trial = 2"),
       "2/9 trace of trial 2 was altered"},
      {"DELETE FROM traces WHERE session = 1 AND trial = 3", "1/13 trace of trial 3 is missing"},
      {"DELETE FROM traces WHERE session = 2", "2/5 trace of trial 1 is missing"},
      {"UPDATE traces SET trial = 7 WHERE session = 1 AND trial = 2",
       "1/9 trace of trial 2 is missing"},
      {"INSERT INTO traces VALUES(2, 9, x'00')", "2/0 trace of trial 9 has no event"},
      {"UPDATE traces SET session = 5 WHERE session = 2 AND trial = 3",
       "2/13 trace of trial 3 is missing"},
      {flipped_blob("participant_keys", "wrapped", "session = 2"),
       "2/0 the participant's key was altered"},
      {"DELETE FROM participant_keys WHERE session = 1",
       "1/0 the participant's key is missing without a withdrawal"},
      {"INSERT INTO participant_keys VALUES(8, x'00')", "8/0 a participant's key has no session"},
      {"INSERT INTO station_keys VALUES(1, x'00')",
       "1/0 the station holds the key of a session that is not open"},
      {"INSERT INTO station_keys VALUES(8, x'00')",
       "8/0 the station holds the key of a session that is not open"},
  });
  StoredFixture study(1);
  study.store->withdraw(1, kUtc, "asked to");
  tamper(study, "INSERT INTO participant_keys VALUES(1, x'00')");
  REQUIRE(study.store->first_fault()->what ==
          "the participant withdrew, but the key is still there");
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
    REQUIRE(contains(line, "restore it from a backup"));
  }
}

TEST_CASE("what a chain cannot show: an open session cut at its end") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  recorder.remarked(seconds(1), EventKind::noted, "late");
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
  REQUIRE(altered("") == "");
  REQUIRE(altered("DROP TRIGGER events_no_delete") ==
          "trigger events_no_delete is missing from the schema");
  REQUIRE(altered("DROP TRIGGER traces_no_update; CREATE TRIGGER traces_no_update BEFORE UPDATE ON "
                  "traces BEGIN SELECT 1; END") ==
          "trigger traces_no_update is not as its schema has it");
}

/// Does what a line says after "remove it: " as a shell would.
void obey(const std::string& line) {
  const TempFolder folder;
  const std::string words = (folder.path() / "words").string();
  replace_file(folder.path() / "script", "sqlite3() { printf '%s\\0' \"$@\" > '" + words +
                                             "'; }\n" + line.substr(line.find("remove it: ") + 11));
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
    CHECK(contains(study.store->first_fault(TraceCheck::skip).value().what, "remove it: "));
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

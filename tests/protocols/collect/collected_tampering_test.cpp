// A collected study that was tampered with, and one whose stations are of an older schema.
#include "protocols/collect/lab_fixture.hpp"
#include "protocols/store/schema.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

/// The first fault of a collected study of two stations after SQL was run on it.
std::string fault_after(const std::string& sql) {
  Lab lab;
  const auto [a, b] = lab.two_stations();
  merge({a, b}, lab.file("C.db"));
  tamper_file(lab.file("C.db"), sql);
  const auto fault = StudyStore::open(lab.file("C.db"), Access::read_only).first_fault();
  if (!fault) return "";
  return std::to_string(fault->session) + "/" + std::to_string(fault->sequence) + " " + fault->what;
}

/// A station's database with the tables of the second schema.
fs::path of_second_schema(const Lab& lab, const fs::path& station) {
  const fs::path path = lab.file("old.db");
  SQLite::Database old(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  old.exec("PRAGMA page_size = 8192; PRAGMA application_id = 0x5454524c; PRAGMA user_version = 2;");
  old.exec("PRAGMA journal_mode = WAL");
  for (const Migration step : migrations().first(2)) step(old);
  old.exec("ATTACH DATABASE '" + station.string() + "' AS now");
  old.exec(
      "INSERT INTO main.events SELECT session, sequence, kind, at_ns, body, sealed, previous, hash "
      "FROM now.events;"
      "INSERT INTO main.traces SELECT * FROM now.traces;"
      "INSERT INTO main.participant_keys SELECT * FROM now.participant_keys;"
      "INSERT INTO main.sessions SELECT session, participant, enrolment, state, simulated, pilot, "
      "excluded, withdrawn, device, replaced_by FROM now.sessions;"
      "INSERT INTO main.trials SELECT * FROM now.trials;"
      "INSERT INTO main.responses SELECT * FROM now.responses;");
  return path;
}

}  // namespace

TEST_CASE("whatever is altered in a collected study is found") {
  CHECK(fault_after("SELECT 1").empty());
  CHECK(fault_after("UPDATE events SET body = '{}' WHERE session = -2 AND sequence = 3") ==
        "-2/3 the hash of the event does not match its content");
  CHECK(fault_after("DELETE FROM events WHERE session = -2") ==
        "0/3 is not what the stations' chains come to");
  CHECK(fault_after("DELETE FROM events WHERE session = -1") == "-1/0 opens no session");
  CHECK(fault_after("DELETE FROM events WHERE session = -2 AND sequence > 2") ==
        "0/7 stands at no station; a collected study has no sessions of its own");
  CHECK(fault_after("UPDATE events SET session = -9 WHERE session = -1;"
                    "UPDATE events SET session = -1 WHERE session = -2;"
                    "UPDATE events SET session = -2 WHERE session = -9") ==
        "-2/0 does not come after that of the station before");
  CHECK(fault_after("DELETE FROM events WHERE session = 0 AND sequence > 4") ==
        "0/0 lacks events that the stations' chains come to");
  CHECK(fault_after("UPDATE events SET own_session = 4 WHERE session = 4") ==
        "4/0 the event belongs to another chain");
  CHECK(fault_after("DELETE FROM events WHERE session = 3") == "0/5 session 2 has no events");
  CHECK(fault_after("UPDATE sessions SET station = 2 WHERE session = 3") ==
        "3/0 derived table sessions disagrees with the events");
  CHECK(fault_after("UPDATE sessions SET own_session = NULL WHERE session = 3") ==
        "3/0 derived table sessions disagrees with the events");
  CHECK(fault_after("DELETE FROM traces WHERE session = 4 AND trial = 2") ==
        "4/9 trace of trial 2 is missing");
}

TEST_CASE("sessions of two stations that changed places are found") {
  CHECK(fault_after("UPDATE events SET session = 99 WHERE session = 1;"
                    "UPDATE events SET session = 1 WHERE session = 2;"
                    "UPDATE events SET session = 2 WHERE session = 99") ==
        "1/0 the session's first event is not the one on the file's chain");
}

TEST_CASE("a session that was added to a collected study behind its back is found") {
  Lab lab;
  const auto [a, b] = lab.two_stations();
  const fs::path one = lab.station("one.db", {{"P5", 5, minutes(50)}});
  merge({a, b}, lab.file("C.db"));
  merge({a, b, one}, lab.file("with.db"));
  // The events that a merge with this station would have, but not the station.
  {
    SQLite::Database raw(lab.file("C.db").string(), SQLite::OPEN_READWRITE);
    raw.exec("ATTACH DATABASE '" + lab.file("with.db").string() + "' AS other");
    raw.exec(
        "INSERT INTO main.events SELECT * FROM other.events WHERE session = 0 AND sequence > 8;"
        "INSERT INTO main.events SELECT * FROM other.events WHERE session = 5;");
  }
  const auto fault = StudyStore::open(lab.file("C.db"), Access::read_only).first_fault();
  REQUIRE(fault);
  CHECK(fault->session == 0);
  CHECK(fault->sequence == 9);
  CHECK(contains(fault->what, "a collected study has no sessions of its own"));
}

TEST_CASE("a station's own file that pretends to hold a station is found") {
  Lab lab;
  const fs::path a = lab.two_stations().first;
  tamper_file(a,
              "INSERT INTO events SELECT -2147483647, sequence, kind, at_ns, body, sealed, "
              "previous, hash, 0 FROM events WHERE session = 0");
  const auto fault = StudyStore::open(a, Access::read_only).first_fault();
  REQUIRE(fault);
  CHECK(fault->what == "opens no session");
}

TEST_CASE("a station's file of an older schema is refused with the remedy, and then collected") {
  Lab lab;
  const auto [a, b] = lab.two_stations();
  merge({a, b}, lab.file("new.db"));
  const fs::path old = of_second_schema(lab, b);
  CHECK(contains(merge_refusal(lab, {a, old}), "`touchtrial migrate` brings it up to date"));
  { const StudyStore store = StudyStore::open(old, Access::read_write); }
  merge({a, old}, lab.file("C.db"));
  CHECK(read_file(lab.file("C.db")) == read_file(lab.file("new.db")));
}

TEST_CASE("a database of the second schema is brought forward with all that it holds") {
  Lab lab;
  const fs::path b = lab.two_stations().second;
  Lab::at(b, [](StudyStore& store) { store.exclude(1, kUtc, "fell asleep"); });
  const fs::path old = of_second_schema(lab, b);
  const StudyStore now = StudyStore::open(b, Access::read_only);
  const StudyStore store = StudyStore::open(old, Access::read_write);
  CHECK(store.sessions() == now.sessions());
  CHECK(store.trials() == now.trials());
  CHECK(store.file_head() == now.file_head());
  CHECK(store.stations() == 0);
  CHECK_FALSE(store.first_fault());
  SQLite::Database copy(backup_path(old, 2).string());
  CHECK(copy.execAndGet("PRAGMA user_version").getInt() == 2);
  CHECK(copy.execAndGet("SELECT count(*) FROM pragma_table_info('events')").getInt() == 8);
}

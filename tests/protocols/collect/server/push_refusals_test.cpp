// Reasons to refuse a push: another study, a participant or number that is taken, foreign tables, a
// chain that was continued separately, missing rights.
#include "protocols/collect/server/server_fixture.hpp"
#include "protocols/collect/server_schema.hpp"
#include "protocols/collect/stations.hpp"
#include "protocols/store/damage.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::collect;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

std::string push_refusal(const ServerFixture& there, const StudyStore& store,
                         const PushOptions& options = {}) {
  return refusal_of([&] { there.push(store, options); });
}

/// Checks that no part of the file reached the server.
void check_untouched(const ServerFixture& there, const std::string& counts_before) {
  CHECK(there.counts() == counts_before);
}

void add_another_table(ServerWork& work) {
  work.exec("ALTER TABLE stations ADD COLUMN room TEXT");
}

}  // namespace

TEST_CASE("a participant id that another station has is refused, and that session is named") {
  const ServerFixture there;
  StoredFixture first(1);
  StoredFixture second;
  SessionOpening how = opening(1);
  how.enrolment = 7;
  how.device = "falcon";
  how.device_serial = "F42";
  how.opened_utc = "2026-01-05T10:00:00Z";
  second.store->add_session(session_of(1, 2, stroking(20, 0.05), how), wrapped_key_of(1), kUtc);
  OpenStation station(*second.store, "room-b.db");
  there.push(station);
  const std::string counts = there.counts();
  for (const bool dry_run : {true, false}) {
    const std::string line = push_refusal(there, *first.store, {.dry_run = dry_run});
    CHECK_THAT(line,
               holds_text("session 1: participant P1 is taken already by session 1 of station "
                          "1 (room-b.db)"));
    CHECK_THAT(line, holds_text("opened 2026-01-05T10:00:00Z on falcon F42"));
    CHECK_THAT(line, holds_text("`touchtrial replace`) and sync that first"));
  }
  check_untouched(there, counts);
}

TEST_CASE("an enrolment number that another station has is refused, and that session is named") {
  const ServerFixture there;
  StoredFixture first(2);
  StoredFixture second;
  add_visit(*second.store, {1, "Q1", 2});
  there.push(*second.store);
  const std::string line = push_refusal(there, *first.store);
  CHECK_THAT(line, holds_text("session 2: enrolment number 2 is taken already by session 1"));
  CHECK_THAT(line, holds_text("participant Q1, enrolment 2"));
  CHECK_THAT(line, holds_text("1 of 2 sessions were pushed"));
  CHECK(there.first("SELECT count(*) FROM sessions") == "2");
}

TEST_CASE("replacing one of two who have the same number lets the other in") {
  const ServerFixture there;
  StoredFixture first(1);
  StoredFixture second;
  add_visit(*second.store, {1, "Q1", 1});
  there.push(*second.store);
  const std::string line = push_refusal(there, *first.store);
  CHECK_THAT(line, holds_text("enrolment number 1 is taken"));
  CHECK_THAT(line, holds_text("run nobody under the successor's id, who would inherit the number"));
  second.store->exclude(1, kUtc, "wrong number");
  second.store->replace(1, "Q2", kUtc, "wrong number");
  there.push(*second.store);
  CHECK(there.push(*first.store).pushed.size() == 1);
}

TEST_CASE("another study, or another kind of the same, is refused with the remedy") {
  const ServerFixture there;
  StoredFixture ours(1);
  there.push(*ours.store);
  const std::string counts = there.counts();
  const auto refused = [&](StudyCommitment body, const std::string& why) {
    body.station = station_identity(body.study_id);
    TempFolder folder;
    StudyStore other = StudyStore::create(folder.path() / "other.db", body, kUtc, investigator());
    SessionOpening how = opening(1);
    how.participant = "Q1";
    how.enrolment = 9;
    how.study_id = body.study_id;
    how.seal = body.seal;
    how.simulated = body.simulated;
    how.pilot = body.pilot;
    other.add_session(session_of(1, 1, stroking(20, 0.05), how), wrapped_key_of(1), kUtc);
    for (const bool dry_run : {true, false}) {
      const std::string line = push_refusal(there, other, {.dry_run = dry_run});
      CHECK_THAT(line, holds_text("holds " + why));
      CHECK_THAT(line, holds_text("createdb"));
    }
  };
  StudyCommitment body = commitment();
  body.study_id = "ffeeddccbbaa99887766554433221100";
  refused(body, "another study");
  body = commitment();
  body.seal = digest_of("another seal");
  refused(body, "this study under another seal");
  body = commitment();
  body.configuration = R"({"classes":["c0"]})";
  refused(body, "this study with another configuration");
  body = commitment();
  body.simulated = false;
  refused(body, "simulated participants");
  body = commitment();
  body.pilot = true;
  refused(body, "the study and not its pilot");
  check_untouched(there, counts);
}

TEST_CASE("tables of another program are left alone") {
  const ServerFixture there;
  there.ask("CREATE TABLE events(id INTEGER); INSERT INTO events VALUES(5)");
  StoredFixture study(1);
  CHECK_THAT(push_refusal(there, *study.store), holds_text("tables of another program"));
  CHECK(there.ask("SELECT id FROM events") == std::vector<std::string>{"5"});
  CHECK(there.first("SELECT count(*) FROM pg_tables WHERE schemaname = 'public'") == "1");
}

TEST_CASE("a study has a schema of its own if the address says so") {
  const ServerFixture there;
  there.ask("CREATE TABLE events(id INTEGER); CREATE SCHEMA pilot");
  StoredFixture study(1);
  OpenStation station(*study.store);
  PushReport report;
  const std::string url = there.url() + "&options=-csearch_path%3D";
  push_station(station, ServerAddress(url + "pilot"), {}, report);
  CHECK(there.first("SELECT count(*) FROM pilot.sessions") == "1");
  CHECK_THAT(refusal_of([&] { push_station(station, ServerAddress(url + "none"), {}, report); }),
             holds_text("CREATE SCHEMA"));
}

TEST_CASE("a newer schema is refused untouched, an older one brought forward") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  const std::array steps = {server_migrations().front(), ServerMigration{add_another_table}};
  ServerConnection server(there.address());
  bring_forward(server, steps);
  CHECK(there.first("SELECT version FROM touchtrial_schema") == "7");
  CHECK(there.first("SELECT count(*) FROM information_schema.columns WHERE column_name = 'room'") ==
        "1");
  bring_forward(server, steps);
  add(*study.store, 2);
  const std::string counts = there.counts();
  CHECK_THAT(push_refusal(there, *study.store),
             holds_text("newer Touchtrial (schema 7, this one knows 6)"));
  CHECK_THAT(push_refusal(there, *study.store, {.dry_run = true}), holds_text("newer Touchtrial"));
  check_untouched(there, counts);
}

TEST_CASE("an unknown older schema is refused untouched") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  there.ask("UPDATE touchtrial_schema SET version = 2");
  add(*study.store, 2);
  const std::string counts = there.counts();
  CHECK_THAT(push_refusal(there, *study.store),
             holds_text("older Touchtrial (schema 2, the oldest that this one knows is 5); use"));
  CHECK_THAT(refusal_of([&] { static_cast<void>(stations_of_server(there.address())); }),
             holds_text("older Touchtrial (schema 2"));
  check_untouched(there, counts);
}

TEST_CASE("a step that fails leaves the schema as it was") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  const std::array steps = {server_migrations().front(), ServerMigration{add_another_table},
                            ServerMigration{[](ServerWork& work) { work.exec("NONSENSE"); }}};
  ServerConnection server(there.address());
  CHECK_THAT(refusal_of([&] { bring_forward(server, steps); }), holds_text("syntax error"));
  CHECK(there.first("SELECT version FROM touchtrial_schema") == "6");
  CHECK(there.first("SELECT count(*) FROM information_schema.columns WHERE column_name = 'room'") ==
        "0");
}

TEST_CASE("a copy that went on by itself is refused, and the message says where it parts") {
  const ServerFixture there;
  StoredFixture study(2);
  study.store.reset();
  StoredFixture copy(study.path);
  copy.store = writable(copy.path);
  study.store = writable(study.path);
  add(*study.store, 3);
  add_visit(*copy.store, {3, "Q3", 9});
  there.push(*study.store);
  const std::string counts = there.counts();
  CHECK_THAT(push_refusal(there, *copy.store), holds_text("has another event 5 of the chain of"));
  check_untouched(there, counts);
}

TEST_CASE("an older copy adds nothing, and is told of what the server has beyond it") {
  const ServerFixture there;
  StoredFixture study(2);
  study.store.reset();
  StoredFixture copy(study.path);
  copy.store = writable(copy.path);
  study.store = writable(study.path);
  add(*study.store, 3);
  there.push(*study.store);
  const PushReport report = there.push(*copy.store);
  CHECK(report.pushed.empty());
  CHECK(report.already_there == 2);
  CHECK(report.ahead == 2);
}

TEST_CASE("a session that is altered on its way does not arrive") {
  const ServerFixture there;
  StoredFixture study(2);
  OpenStation station(*study.store);
  const auto refused = [&](const std::string& why) {
    CHECK_THAT(refusal_of([&] { there.push(station); }), holds_text(why));
    CHECK(there.first("SELECT count(*) FROM sessions") == "0");
    CHECK(there.first("SELECT count(*) FROM events") == "0");
  };
  station.alter = [](std::vector<Event>& events) { events[3].body += " "; };
  refused("session 1 did not arrive whole: event 3");
  station.alter = [](std::vector<Event>& events) { events[2].sealed.push_back(0); };
  refused("session 1 did not arrive whole: event 2");
  station.alter = [](std::vector<Event>& events) { events.pop_back(); };
  refused("session 1 did not arrive whole: it ends with another event");
  station.alter = {};
  station.alter_trace = [](int trial, Bytes& box) {
    if (trial == 2) box.back() ^= 1;
  };
  refused("session 1 did not arrive whole: the trace of trial 2");
  station.alter_trace = {};
  CHECK(there.push(station).pushed.size() == 2);
}

TEST_CASE("a role without rights is refused in one line") {
  const ServerFixture there;
  there.ask("CREATE ROLE guest LOGIN");
  StoredFixture study(1);
  OpenStation station(*study.store);
  PushReport report;
  CHECK_THAT(refusal_of([&] { push_station(station, there.address("guest"), {}, report); }),
             holds_text("permission denied"));
  there.push(*study.store);
  add(*study.store, 2);
  CHECK_THAT(refusal_of([&] { push_station(station, there.address("guest"), {}, report); }),
             holds_text("docs/several-stations.md"));
}

TEST_CASE("a role that was admitted can push") {
  const ServerFixture there;
  StoredFixture study;
  there.push(*study.store);
  there.ask("CREATE ROLE station LOGIN");
  there.ask("SELECT touchtrial_admit('station')");
  add(*study.store, 1);
  add(*study.store, 2);
  OpenStation station(*study.store);
  PushReport report;
  push_station(station, there.address("station"), {}, report);
  CHECK(report.pushed.size() == 2);
  study.store->withdraw(1, kUtc, "asked");
  study.store->exclude(2, kUtc, "slept");
  push_station(station, there.address("station"), {}, report);
  CHECK(there.ask("SELECT session FROM participant_keys").size() == 1);
  add(*study.store, 3);
  study.store->replace(2, "P9", kUtc, "slept");
  push_station(station, there.address("station"), {}, report);
  CHECK(there.first("SELECT replaced_by FROM sessions WHERE own_session = 2") == "P9");
}

TEST_CASE("tables of a version whose stations could alter each other's rows are refused") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  there.ask("DROP TABLE station_roles");
  CHECK_THAT(push_refusal(there, *study.store), holds_text("earlier Touchtrial"));
}

TEST_CASE("a key that somebody deleted or changed comes back with the next push") {
  const ServerFixture there;
  StoredFixture study(3);
  there.push(*study.store);
  const std::string keys = "SELECT encode(wrapped, 'hex') FROM participant_keys ORDER BY session";
  const std::vector<std::string> before = there.ask(keys);
  there.ask("DELETE FROM participant_keys WHERE session = 1");
  there.ask(
      "UPDATE participant_keys SET wrapped = set_byte(wrapped, 3, 1 + get_byte(wrapped, 3) "
      "% 255) WHERE session = 2");
  CHECK(there.push(*study.store).keys_restored == 2);
  CHECK(there.ask(keys) == before);
  CHECK(there.push(*study.store).keys_restored == 0);
  study.store->withdraw(1, kUtc, "asked");
  CHECK(there.push(*study.store).keys_restored == 0);
  CHECK(there.ask(keys).size() == 2);
}

TEST_CASE("an older copy does not bring back the key of a participant who withdrew since") {
  const ServerFixture there;
  StoredFixture study(2);
  TempFolder folder;
  const auto copy = folder.path() / "copy.db";
  study.store.reset();
  std::filesystem::copy_file(study.path, copy);
  {
    StudyStore store = writable(study.path);
    store.withdraw(1, kUtc, "asked");
    there.push(store);
  }
  // Not even if the mark in the derived table was removed.
  there.ask("UPDATE sessions SET withdrawn = 0");
  const StudyStore older = StudyStore::open(copy, StudyStore::Access::read_only);
  const PushReport report = there.push(older);
  CHECK(report.ahead > 0);
  CHECK(report.keys_restored == 0);
  CHECK(there.first("SELECT count(*) FROM participant_keys") == "1");
}

TEST_CASE("the key of a participant who withdrew is no longer in the table's file") {
  const ServerFixture there;
  StoredFixture study(2);
  there.push(*study.store);
  const std::string key =
      there.first("SELECT encode(wrapped, 'hex') FROM participant_keys ORDER BY session DESC");
  const auto is_in_file = [&] {
    there.ask("CHECKPOINT");
    return there.first("SELECT position(decode('" + key +
                       "', 'hex') IN pg_read_binary_file(pg_relation_filepath("
                       "'participant_keys'))) > 0") == "t";
  };
  CHECK(is_in_file());
  study.store->withdraw(2, kUtc, "asked");
  there.push(*study.store);
  CHECK_FALSE(is_in_file());
}

TEST_CASE("a lost end of a station's chain gives another error than a place that is taken") {
  const ServerFixture there;
  StoredFixture study(2);
  there.push(*study.store);
  there.tamper("DELETE FROM events WHERE session = -1 AND sequence >= 3");
  const std::string counts = there.counts();
  for (const bool dry_run : {true, false}) {
    try {
      there.push(*study.store, {.dry_run = dry_run});
      FAIL("was not refused");
    } catch (const DamagedStore& error) {
      CHECK_THAT(error.what(), holds_text("lost the end of the chain of station 1"));
      CHECK_THAT(error.what(), holds_text("sync all stations again"));
    }
  }
  check_untouched(there, counts);
}

TEST_CASE("damage on the server is reported in one clean line, with a remedy") {
  const auto refusal_after = [](const std::string& sql) {
    const ServerFixture there;
    StoredFixture study(1);
    there.push(*study.store);
    add(*study.store, 2);
    there.tamper(sql);
    std::string line;
    bool is_damage = false;
    try {
      there.push(*study.store);
      static_cast<void>(sessions_on_server(there.address()));
    } catch (const DamagedStore& error) {
      line = error.what();
      is_damage = true;
    } catch (const StoreError& error) {
      line = error.what();
    }
    INFO(sql << ": " << line);
    CHECK(is_damage);
    CHECK(line.find("  ") == std::string::npos);
    CHECK(line.find("LINE 1") == std::string::npos);
    CHECK(line.find('^') == std::string::npos);
    return line;
  };
  CHECK_THAT(refusal_after("UPDATE events SET body = '{}' WHERE session = -1 AND sequence = 0"),
             holds_text("station 1, file chain, event 0"));
  CHECK_THAT(refusal_after("UPDATE sessions SET state = 'bogus'"),
             holds_text("session 1 of the server: no state of a session: bogus"));
  CHECK_THAT(refusal_after("UPDATE sessions SET enrolment = 0"), holds_text("below 1"));
  CHECK_THAT(refusal_after("DROP TABLE traces"), holds_text("sync all stations again"));
  CHECK_THAT(refusal_after("ALTER TABLE trials DROP COLUMN block"),
             holds_text("sync all stations again"));
}

TEST_CASE("a read-only database is reported") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  add(*study.store, 2);
  there.ask("ALTER DATABASE " + there.database + " SET default_transaction_read_only = on");
  CHECK_THAT(push_refusal(there, *study.store), holds_text("the database is read-only"));
}

TEST_CASE("an impatient server lets a push take its time") {
  const ServerFixture there;
  there.ask("ALTER DATABASE " + there.database + " SET statement_timeout = 1");
  StoredFixture study(2);
  CHECK(there.push(*study.store).pushed.size() == 2);
}

TEST_CASE("a file whose name is not UTF-8 is pushed under a cleaned one") {
  const ServerFixture there;
  StoredFixture study(1);
  OpenStation station(*study.store, "/data/lab\xff.db");
  CHECK(there.push(station).pushed.size() == 1);
  CHECK(there.first("SELECT name FROM stations") == "lab\\xff.db");
}

TEST_CASE("a database whose encoding would change texts is refused") {
  const ServerFixture there;
  there.server.make_database("latin", "LATIN1");
  StoredFixture study(1);
  OpenStation station(*study.store);
  PushReport report;
  CHECK_THAT(refusal_of([&] {
               push_station(station, ServerAddress(there.server.url("latin")), {}, report);
             }),
             holds_text("createdb --encoding=UTF8"));
}

TEST_CASE("a database without an encoding keeps texts as they are") {
  const ServerFixture there;
  there.server.make_database("plain", "SQL_ASCII");
  StoredFixture study(1);
  study.store->unblind(kUtc, "sch\xc3\xb6n \xe2\x9c\x93", /*interim=*/true);
  OpenStation station(*study.store);
  PushReport report;
  push_station(station, ServerAddress(there.server.url("plain")), {}, report);
  CHECK(report.pushed.size() == 1);
  CHECK(there.server.ask("plain", "SELECT count(*) FROM events WHERE body LIKE '%sch\xc3\xb6n%'") ==
        std::vector<std::string>{"1"});
}

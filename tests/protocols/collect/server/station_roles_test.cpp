// What one station's role could do to the others, and cannot.
#include "protocols/collect/server/server_fixture.hpp"
#include "protocols/collect/server_connection.hpp"
#include "support/catch.hpp"

#include <stdexcept>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::collect;
using namespace touchtrial::fixture;
using namespace touchtrial::store;

namespace {

/// A study with two stations, each pushed under a role of its own: lab_a is 1, lab_b is 2.
struct TwoLabs {
  TwoLabs() {
    const StoredFixture empty;
    there.push(*empty.store);  // makes the tables
    add_visit(*second.store, {1, "Q1", 11});
    add_visit(*second.store, {2, "Q2", 12});
    if (there.ask("SELECT rolname FROM pg_roles WHERE rolname = 'lab_a'").empty()) {
      there.ask("CREATE ROLE lab_a LOGIN; CREATE ROLE lab_b LOGIN");
    }
    there.ask("SELECT touchtrial_admit('lab_a')");
    there.ask("SELECT touchtrial_admit('lab_b')");
    CHECK(push_as("lab_a", *first.store).station == 1);
    CHECK(push_as("lab_b", *second.store).station == 2);
  }

  PushReport push_as(const std::string& role, const StudyStore& store) const {
    OpenStation station(store);
    PushReport report;
    push_station(station, there.address(role), {}, report);
    return report;
  }
  /// \return what the server complains of; empty if it did not
  std::string tries(const std::string& role, const std::string& sql) const {
    try {
      there.ask("SET SESSION AUTHORIZATION " + role + "; " + sql);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  /// Everything that the first station has on the server.
  std::vector<std::string> of_first() const {
    std::vector<std::string> rows;
    for (const std::string table :
         {"events", "traces", "participant_keys", "safety_keys", "sessions", "trials"}) {
      const std::string own = "SELECT r::text FROM " + table +
                              " r WHERE session BETWEEN -1 AND 100000 ORDER BY r::text";
      for (std::string& row : there.ask(own)) rows.push_back(std::move(row));
    }
    for (std::string& row : there.ask("SELECT r::text FROM stations r WHERE station = 1")) {
      rows.push_back(std::move(row));
    }
    return rows;
  }

  const ServerFixture there;
  StoredFixture first{2};
  StoredFixture second;
};

}  // namespace

TEST_CASE("a station's role adds its own sessions, and alters nobody's") {
  TwoLabs labs;
  const std::vector<std::string> before = labs.of_first();
  REQUIRE_FALSE(before.empty());
  for (const char* const attack :
       {"DELETE FROM participant_keys",
        "UPDATE participant_keys SET wrapped = ''",
        "INSERT INTO participant_keys VALUES(3, '')",
        "SELECT touchtrial_destroy_key(1)",
        "SELECT touchtrial_destroy_key(1, TRUE)",
        "DELETE FROM safety_keys",
        "DELETE FROM events",
        "UPDATE events SET body = ''",
        "TRUNCATE traces",
        "DROP TABLE events",
        "ALTER TABLE events DISABLE TRIGGER ALL",
        "ALTER TABLE events DISABLE ROW LEVEL SECURITY",
        "INSERT INTO events(session, sequence) VALUES(1, 99)",
        "INSERT INTO events(session, sequence) VALUES(-1, 99)",
        "INSERT INTO traces(session, trial) VALUES(1, 99)",
        "INSERT INTO trials(session, trial) VALUES(2, 99)",
        "INSERT INTO sessions(session, station, own_session) VALUES(3, 1, 3)",
        "INSERT INTO sessions(session, station, own_session) VALUES(100003, 1, 3)",
        "INSERT INTO sessions(session, station, own_session) VALUES(3, 2, 3)",
        "UPDATE sessions SET session = 3",
        "UPDATE sessions SET station = 2",
        "UPDATE stations SET name = 'x'",
        "INSERT INTO stations VALUES(3, '\\x03', 'x')",
        "INSERT INTO stations VALUES(2, '\\x03', 'x')",
        "INSERT INTO station_roles VALUES(9, 'x')",
        "UPDATE station_roles SET station = 1",
        "SELECT touchtrial_admit('lab_b', 1)",
        "LOCK TABLE participant_keys IN SHARE MODE",
        "LOCK TABLE sessions IN ACCESS EXCLUSIVE MODE",
        "SELECT FROM station_roles FOR UPDATE",
        "SELECT nextval('session_numbers')",
        "CREATE TABLE more(a INTEGER)",
        "CREATE TEMPORARY TABLE station_roles(station INTEGER, role NAME); INSERT INTO "
        "pg_temp.station_roles VALUES(1, 'lab_b'); SELECT touchtrial_destroy_key(1)"}) {
    INFO(attack);
    CHECK_FALSE(labs.tries("lab_b", attack).empty());
  }
  // Rows that a role may not touch are not there for it.
  CHECK(labs.tries("lab_b", "UPDATE sessions SET withdrawn = 1, excluded = 1").empty());
  CHECK(labs.tries("lab_b", "SELECT session FROM sessions FOR UPDATE").empty());
  CHECK(labs.there.ask("SET SESSION AUTHORIZATION lab_b; SELECT session FROM participant_keys "
                       "ORDER BY session") == std::vector<std::string>{"100001", "100002"});
  CHECK(labs.of_first() == before);
  CHECK(labs.there.first("SELECT count(*) FROM sessions WHERE withdrawn = 1") == "2");
}

TEST_CASE("a station's role that holds every lock it can get hinders nobody's push") {
  TwoLabs labs;
  ServerConnection attacker(labs.there.address("lab_b"));
  add(*labs.first.store, 3);
  labs.first.store->withdraw(1, kUtc, "asked");
  attacker.change([&](ServerWork& work) {
    work.exec("SELECT touchtrial_lock_station(identity) FROM stations");
    work.exec("UPDATE sessions SET excluded = 1");
    work.exec("LOCK TABLE events, traces, sessions, participant_keys IN ROW EXCLUSIVE MODE");
    work.exec(
        "SELECT pg_advisory_xact_lock(hashtextextended('touchtrial ' || current_schema(), "
        "0))");
    work.exec(
        "SELECT pg_advisory_xact_lock(hashtextextended('touchtrial ' || current_schema() || "
        "encode(identity, 'hex'), 0)) FROM stations");
    const PushReport report = labs.push_as("lab_a", *labs.first.store);
    CHECK(report.pushed.size() == 1);
    CHECK(report.keys_destroyed == 1);
    CHECK(report.reconnections == 0);
  });
}

TEST_CASE("a role is one station, and no other file is pushed under it") {
  const TwoLabs labs;
  StoredFixture third;
  add_visit(*third.store, {1, "R1", 21});
  try {
    labs.push_as("lab_a", *third.store);
    FAIL("was not refused");
  } catch (const StoreError& error) {
    CHECK_THAT(error.what(), holds_text("this role is station 1"));
  }
}

TEST_CASE("a destroyed key is reported, and that only the owner can wipe its bytes") {
  TwoLabs labs;
  labs.first.store->withdraw(1, kUtc, "asked");
  const PushReport by_role = labs.push_as("lab_a", *labs.first.store);
  CHECK(by_role.keys_destroyed == 1);
  CHECK_FALSE(by_role.keys_wiped);
  CHECK(labs.push_as("lab_a", *labs.first.store).keys_destroyed == 0);
  labs.first.store->withdraw(2, kUtc, "asked");
  const PushReport by_owner = labs.there.push(*labs.first.store);
  CHECK(by_owner.keys_destroyed == 1);
  CHECK(by_owner.keys_wiped);
}

// Reading the stations' data back from the server.
#include "protocols/collect/server/server_fixture.hpp"
#include "protocols/collect/stations.hpp"
#include "protocols/store/damage.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::collect;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

void check_same(const std::vector<Event>& found, const std::vector<Event>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].session == expected[i].session);
    CHECK(found[i].hash == expected[i].hash);
    CHECK(event_hash(found[i]) == expected[i].hash);
    CHECK_FALSE(found[i].renumbered_from);
  }
}

/// Two stations of two sessions each; the second's are P3 and P4 with its own numbers 1 and 2.
struct TwoStations {
  TwoStations() {
    add_visit(*second.store, {1, "P3", 3});
    add_visit(*second.store, {2, "P4", 4});
    there.push(*first.store);
    there.push(*second.store);
  }

  ServerFixture there;
  StoredFixture first{2};
  StoredFixture second;
};

}  // namespace

TEST_CASE("a station read from the server equals the station's file") {
  TwoStations both;
  both.second.store->withdraw(2, kUtc, "asked");
  both.there.push(*both.second.store);
  Stations stations = stations_of_server(both.there.address());
  REQUIRE(stations.size() == 2);
  OpenStation expected(*both.second.store);
  StationFile& found = *stations[1];
  CHECK_THAT(found.name(), holds_text("station 2 (study.db)"));
  check_same(found.file_chain(), expected.file_chain());
  for (const int session : {1, 2}) {
    check_same(found.events(session), expected.events(session));
    CHECK(found.wrapped_keys(session) == expected.wrapped_keys(session));
    CHECK(found.trace(session, 2) == expected.trace(session, 2));
    std::map<int, Bytes> traces;
    found.for_each_trace(session, [&](int trial, const Bytes& box) { traces[trial] = box; });
    REQUIRE(traces.size() == 3);
    for (const auto& [trial, box] : traces) CHECK(box == expected.trace(session, trial));
  }
  CHECK_FALSE(found.wrapped_keys(2).participant);
  CHECK(found.events(3).empty());
  CHECK_FALSE(found.wrapped_keys(3).participant);
  CHECK_FALSE(found.trace(1, 99));
}

TEST_CASE("a reader sees one moment, whatever is pushed meanwhile") {
  const ServerFixture there;
  StoredFixture study(1);
  there.push(*study.store);
  Stations stations = stations_of_server(there.address());
  add(*study.store, 2);
  study.store->withdraw(1, kUtc, "asked");
  there.push(*study.store);
  CHECK(stations[0]->file_chain().size() == 3);
  CHECK(stations[0]->wrapped_keys(1).participant);
  CHECK(stations_of_server(there.address())[0]->file_chain().size() == 6);
}

TEST_CASE("many and large traces are read in pieces and are the same") {
  const ServerFixture there;
  StoredFixture study;
  const Trace large = stroking(60'000, 3.0);
  study.store->add_session(session_of(1, 36, large, opening(1)), wrapped_key_of(1), kUtc);
  there.push(*study.store);
  CHECK(std::stoll(there.first("SELECT sum(octet_length(box)) FROM traces")) > 16 << 20);
  Stations stations = stations_of_server(there.address());
  int traces = 0;
  stations[0]->for_each_trace(1, [&](int trial, const Bytes& box) {
    CHECK(trial == ++traces);
    CHECK(study.store->sealed_trace(1, trial)->box == box);
  });
  CHECK(traces == 36);
}

TEST_CASE("a role that may only read can read, and a role without rights is refused") {
  TwoStations both;
  both.there.ask(
      "CREATE ROLE reader LOGIN; CREATE ROLE stranger LOGIN;"
      "GRANT SELECT ON ALL TABLES IN SCHEMA public TO reader");
  CHECK(stations_of_server(both.there.address("reader")).size() == 2);
  CHECK_THAT(
      refusal_of([&] { static_cast<void>(stations_of_server(both.there.address("stranger"))); }),
      holds_text("permission denied"));
}

TEST_CASE("a database without a study is reported") {
  const ServerFixture there;
  const auto refusal = [&] {
    return refusal_of([&] { static_cast<void>(stations_of_server(there.address())); });
  };
  CHECK_THAT(refusal(), holds_text("holds no study yet"));
  StoredFixture study;
  there.push(*study.store);
  CHECK_THAT(refusal(), holds_text("holds no study yet"));
}

TEST_CASE("a station that has only a name is ignored") {
  TwoStations both;
  both.there.ask("INSERT INTO stations VALUES(7, '\\x07', 'ghost.db')");
  CHECK(stations_of_server(both.there.address()).size() == 2);
}

TEST_CASE("rows that nobody pushed count as damage") {
  const auto refusal_after = [](const std::string& sql) {
    TwoStations both;
    both.there.tamper(sql);
    std::string line;
    try {
      for (const auto& station : stations_of_server(both.there.address())) {
        static_cast<void>(station->file_chain());
        for (const int session : {1, 2}) static_cast<void>(station->events(session));
      }
    } catch (const DamagedStore& error) {
      line = error.what();
    }
    return line;
  };
  CHECK_THAT(refusal_after("INSERT INTO traces VALUES(77, 1, 'x')"),
             holds_text("table traces holds rows of session 77"));
  CHECK_THAT(refusal_after("INSERT INTO participant_keys VALUES(78, 'x')"),
             holds_text("table participant_keys holds rows of session 78"));
  CHECK_THAT(refusal_after("UPDATE events SET session = 79 WHERE session = 1"),
             holds_text("table events holds rows of session 79"));
  CHECK_THAT(refusal_after("INSERT INTO events VALUES(0, 0, 'noted', 0, '{}', '', '', '', '', 0)"),
             holds_text("holds rows of session 0"));
  CHECK_THAT(
      refusal_after("UPDATE events SET kind = 'nonsense' WHERE session = 2 AND sequence = 3"),
      holds_text("station 1 (study.db), session 2, event 3: unknown kind of event 'nonsense'"));
  CHECK_THAT(
      refusal_after("UPDATE events SET hash = 'short' WHERE session = -1 AND sequence = 1"),
      holds_text(
          "station 1 (study.db), file chain, event 1: a hash of the event is not 32 bytes long"));
  CHECK_THAT(refusal_after("UPDATE events SET own_session = 5000000000 WHERE session = 1"),
             holds_text("no session of a station has this number"));
  CHECK_THAT(refusal_after("UPDATE events SET body = repeat('x', 70000000) WHERE session = 1 AND "
                           "sequence = 4"),
             holds_text("station 1 (study.db), session 1, event 4: the event is absurdly large"));
}

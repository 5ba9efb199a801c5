// Reading the study that several stations pushed to a server.
#include "protocols/collect/collect.hpp"
#include "protocols/collect/server/server_fixture.hpp"
#include "protocols/store/damage.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::collect;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

/// P1 and P4 at one station, P3 and P2 at another; pushed in this order.
struct CollectedStudy {
  CollectedStudy() {
    add_visit(*first.store, {1, "P1", 1});
    add_visit(*first.store, {2, "P4", 4});
    add_visit(*second.store, {1, "P3", 3});
    add_visit(*second.store, {2, "P2", 2});
    first.store->exclude(2, kUtc, "slept");
    there.push(*first.store);
    there.push(*second.store);
  }

  [[nodiscard]] StudyStore from_files() {
    first.store.reset();
    second.store.reset();
    Stations stations = stations_of_file(second.path);
    for (auto& station : stations_of_file(first.path)) stations.push_back(std::move(station));
    return collected_for_reading(std::move(stations), "files", TraceUse::copied);
  }
  [[nodiscard]] StudyStore from_server(TraceUse traces) const {
    return open_study(there.url(), traces);
  }

  ServerFixture there;
  StoredFixture first;
  StoredFixture second;
};

/// The message with which a study on a server is refused after SQL changed it.
std::string refusal_after(const std::string& sql) {
  CollectedStudy study;
  study.there.tamper(sql);
  try {
    const StudyStore store = study.from_server(TraceUse::copied);
    const auto fault = store.first_fault();
    return fault ? "found only by first_fault: " + fault->what : "";
  } catch (const DamagedStore& error) {
    return error.what();
  } catch (const StoreError& error) {
    return "not as damage: " + std::string(error.what());
  }
}

}  // namespace

TEST_CASE("a study read from a server is the one that the stations' files make") {
  CollectedStudy study;
  const StudyStore files = study.from_files();
  for (const TraceUse traces : {TraceUse::copied, TraceUse::fetched}) {
    const StudyStore server = study.from_server(traces);
    CHECK(server.file_head() == files.file_head());
    CHECK(server.sessions() == files.sessions());
    CHECK(server.trials() == files.trials());
    CHECK(server.stations() == 2);
    for (const SessionRow& row : files.sessions()) {
      CHECK(server.wrapped_key(row.session) == files.wrapped_key(row.session));
      for (int trial = 1; trial <= 3; ++trial) {
        REQUIRE(files.sealed_trace(row.session, trial));
        CHECK(server.sealed_trace(row.session, trial) == files.sealed_trace(row.session, trial));
      }
    }
    CHECK_FALSE(server.first_fault(TraceCheck::skip));
  }
  CHECK_FALSE(study.from_server(TraceUse::copied).first_fault());
}

TEST_CASE("stations that each replaced one of a pair are read as they were pushed") {
  const ServerFixture there;
  StoredFixture first;
  StoredFixture second;
  add_visit(*first.store, {1, "A01", 1});
  add_visit(*first.store, {2, "A02", 2});
  first.store->exclude(1, kUtc, "slept");
  first.store->replace(1, "A03", kUtc, "slept");
  add_visit(*second.store, {1, "B01", 1});
  add_visit(*second.store, {2, "B02", 2});
  second.store->exclude(2, kUtc, "slept");
  second.store->replace(2, "B03", kUtc, "slept");
  there.push(*first.store);
  there.push(*second.store);
  const StudyStore study = open_study(there.url(), TraceUse::copied);
  CHECK(study.sessions().size() == 4);
  CHECK(study.session_of("A02").value().replaced_by.empty());
  CHECK(study.session_of("B01").value().replaced_by.empty());
  CHECK_FALSE(study.first_fault());
}

TEST_CASE("a session withdrawn at a station cannot be read from the server after the next push") {
  CollectedStudy study;
  study.second.store->withdraw(1, kUtc, "asked");
  study.there.push(*study.second.store);
  const StudyStore server = study.from_server(TraceUse::copied);
  CHECK_FALSE(server.first_fault());
  const auto row = server.session_of("P3");
  REQUIRE(row);
  CHECK(row->withdrawn);
  CHECK_FALSE(server.wrapped_key(row->session));
}

TEST_CASE("every alteration on the server is found, and named by station and session") {
  // Sessions 1 and 2 are the first station's, 100001 and 100002 the second's.
  const auto check = [](const std::string& sql, const std::vector<std::string>& words) {
    const std::string line = refusal_after(sql);
    INFO(sql);
    INFO(line);
    for (const std::string& word : words) CHECK_THAT(line, holds_text(word));
    CHECK(line.find("not as damage") == std::string::npos);
    CHECK(line.find("found only") == std::string::npos);
  };
  check("UPDATE events SET body = body || ' ' WHERE session = 100001 AND sequence = 4",
        {"station 2", "session 1"});
  check("UPDATE events SET sealed = '\\x00' WHERE session = 100002 AND sequence = 0",
        {"station 2", "session 2"});
  check("UPDATE events SET at_ns = at_ns + 1 WHERE session = -1 AND sequence = 1", {"station 1"});
  check("DELETE FROM events WHERE session = 2 AND sequence = 6", {"station 1", "session 2"});
  check("DELETE FROM traces WHERE session = 100001 AND trial = 2", {"station 2", "session 1"});
  check("UPDATE traces SET box = set_byte(box, 9, 7) WHERE session = 1 AND trial = 1",
        {"station 1", "session 1"});
  check(
      "UPDATE participant_keys SET session = session + 900000; "
      "UPDATE participant_keys SET session = 1000003 - session",
      {"station", "key"});
  check("DELETE FROM participant_keys WHERE session = 2", {"station 1", "session 2", "key"});
  check("UPDATE sessions SET enrolment = 77 WHERE session = 2",
        {"station 1", "session 2", "derived table sessions"});
  check("UPDATE trials SET valid = 1 - valid WHERE session = 100002 AND trial = 3",
        {"station 2", "session 2", "derived table trials"});
  check("UPDATE trials SET state = 'timed-out' WHERE session = 1 AND trial = 1",
        {"station 1", "session 1", "trials"});
  check("DELETE FROM trials WHERE session = 100002 AND trial = 3", {"derived table trials"});
  check("DELETE FROM sessions WHERE session = 100002", {"session 100002"});
}

TEST_CASE("an address with a password opens nothing, and is not repeated") {
  for (const char* const where :
       {"postgresql://anna:geheim@lab/study", "postgressql://anna:geheim@lab/study"}) {
    try {
      static_cast<void>(open_study(where));
      FAIL("it was opened");
    } catch (const UsageError& error) {
      CHECK(std::string(error.what()).find("geheim") == std::string::npos);
    }
  }
}

TEST_CASE("a study is named by its file, or by its server without the user") {
  CHECK(study_name("/data/study.db") == "study.db");
  CHECK(study_name("postgresql://anna@lab/study") == "postgresql://lab/study");
}

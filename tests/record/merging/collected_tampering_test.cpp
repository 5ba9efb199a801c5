// A collected study that was tampered with.
#include "record/merging/lab_fixture.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

/// The place of a collected study's first fault after SQL was run on it: "session/sequence".
std::string fault_after(const std::string& sql) {
  TwoStations lab;
  merge({lab.a, lab.b}, lab.file("C.db"));
  tamper_file(lab.file("C.db"), sql);
  const auto fault = StudyStore::open(lab.file("C.db"), Access::read_only).first_fault();
  return fault ? place_of(*fault) : "";
}

}  // namespace

TEST_CASE("every alteration of a collected study is found") {
  CHECK(fault_after("SELECT 1").empty());
  const std::vector<std::pair<std::string, std::string>> tamperings = {
      {"UPDATE events SET body = '{}' WHERE session = -2 AND sequence = 3", "-2/3"},
      {"DELETE FROM events WHERE session = -2", "0/3"},
      {"DELETE FROM events WHERE session = -1", "-1/0"},
      {"DELETE FROM events WHERE session = -2 AND sequence > 2", "0/7"},
      {"UPDATE events SET session = -9 WHERE session = -1;"
       "UPDATE events SET session = -1 WHERE session = -2;"
       "UPDATE events SET session = -2 WHERE session = -9",
       "-2/0"},
      {"DELETE FROM events WHERE session = 0 AND sequence > 4", "0/0"},
      {"UPDATE events SET own_session = 4 WHERE session = 4", "4/0"},
      {"UPDATE events SET session = 99 WHERE session = 1;"
       "UPDATE events SET session = 1 WHERE session = 2;"
       "UPDATE events SET session = 2 WHERE session = 99",
       "1/0"},
      {"DELETE FROM events WHERE session = 3", "0/5"},
      {"DELETE FROM traces WHERE session = 4 AND trial = 2", "4/9"}};
  for (const auto& [sql, fault] : tamperings) {
    INFO(sql);
    CHECK(fault_after(sql) == fault);
  }
}

TEST_CASE("a session that was added to a collected study behind its back is found") {
  TwoStations lab;
  const fs::path one = lab.station("one.db", {{"P5", 5, minutes(50)}});
  merge({lab.a, lab.b}, lab.file("C.db"));
  merge({lab.a, lab.b, one}, lab.file("with.db"));
  // The events that a merge with this station would have, without the station itself.
  {
    SQLite::Database raw(lab.file("C.db").string(), SQLite::OPEN_READWRITE);
    raw.exec("ATTACH DATABASE '" + lab.file("with.db").string() + "' AS other");
    raw.exec(
        "INSERT INTO main.events SELECT * FROM other.events WHERE session = 0 AND sequence > 8;"
        "INSERT INTO main.events SELECT * FROM other.events WHERE session = 5;");
  }
  const auto fault = StudyStore::open(lab.file("C.db"), Access::read_only).first_fault();
  REQUIRE(fault);
  CHECK(place_of(*fault) == "0/9");
}

TEST_CASE("a station's own file that pretends to hold a station is found") {
  TwoStations lab;
  tamper_file(lab.a,
              "INSERT INTO events SELECT -2147483647, sequence, kind, at_ns, body, sealed, "
              "previous, hash, signature, 0 FROM events WHERE session = 0");
  const auto fault = StudyStore::open(lab.a, Access::read_only).first_fault();
  REQUIRE(fault);
  CHECK(place_of(*fault) == "-1/0");
}

// Studies and files that cannot be collected, and the messages that say so.
#include "record/damage.hpp"
#include "record/merging/lab_fixture.hpp"
#include "support/catch.hpp"
#include "support/fault_vfs.hpp"

using namespace touchtrial;
using namespace touchtrial::merging;
using namespace touchtrial::record;
using namespace touchtrial::fixture;
using touchtrial::testing::Fault;
using touchtrial::testing::FaultVfs;

namespace {

/// The message with which a merge of A and B is refused after B was tampered with; it must name B.
std::string refused_after(const std::string& sql) {
  TwoStations lab;
  tamper_file(lab.b, sql);
  const std::string line = merge_refusal(lab, {lab.a, lab.b});
  REQUIRE(contains(line, lab.b.string()));
  return line;
}

}  // namespace

TEST_CASE("a station that was tampered with is refused by file, session and event") {
  CHECK(names_in_order(refused_after("UPDATE events SET body = replace(body, '\"trial\":1', "
                                     "'\"trial\":2') WHERE session = 2 AND kind = 'answered'"),
                       "2 4 [altered-event]"));
  CHECK(names(refused_after("DELETE FROM events WHERE session = 0 AND sequence = 2"), "2"));
  CHECK(names_in_order(refused_after("UPDATE events SET own_session = 7 WHERE session = 2"),
                       "2 0 [other-chain]"));
  CHECK(names_in_order(refused_after("DELETE FROM traces WHERE session = 1 AND trial = 1"),
                       "1 5 1 [missing-trace]"));
  CHECK(
      names_in_order(refused_after("UPDATE participant_keys SET wrapped = x'00' WHERE session = 2"),
                     "2 0 [altered-key]"));
}

TEST_CASE("tampering with a station gives another error than a station that cannot be merged") {
  TwoStations lab;
  tamper_file(lab.b, "UPDATE participant_keys SET wrapped = x'00' WHERE session = 1");
  CHECK_THROWS_AS(stations_in({lab.a, lab.b}), DamagedStore);
  CHECK_THROWS_AS(stations_in({lab.a, lab.file("none.db")}), StoreError);
}

TEST_CASE("a file that is no station's database is refused with the remedy") {
  TwoStations lab;
  CHECK(contains(merge_refusal(lab, {lab.a, lab.file("none.db")}), "none.db"));
  fs::resize_file(lab.b, 20'000);
  CHECK(names(merge_refusal(lab, {lab.a, lab.b}), "B.db"));
}

TEST_CASE("an existing file is never overwritten") {
  TwoStations lab;
  const Bytes before = read_file(lab.b);
  CHECK(refuses([&] { merge({lab.a, lab.b}, lab.b); }, "B.db"));
  CHECK(read_file(lab.b) == before);
}

TEST_CASE("stations of different studies, of pilots or of simulated people are not pooled") {
  Lab lab;
  const fs::path a = lab.station("A.db", {{"P1", 1, minutes(1)}});
  const auto refused = [&](const std::string& code, void (*change)(StudyCommitment&)) {
    StudyCommitment other = lab_commitment();
    change(other);
    static int number = 0;
    const fs::path b = lab.station("B" + std::to_string(++number), {{"P2", 2, minutes(2)}}, other);
    const std::string line = merge_refusal(lab, {a, b});
    CHECK(names(line, a.string() + " " + b.string() + " " + code));
  };
  const auto is_other_study = [](StudyCommitment& c) {
    c.study_id = "ff";
    c.station = station_identity(c.study_id);
  };
  refused("[other-study]", is_other_study);
  refused("[simulated]", [](StudyCommitment& c) { c.simulated = true; });
  refused("[pilot]", [](StudyCommitment& c) { c.pilot = true; });
  refused("[other-seal]", [](StudyCommitment& c) { c.seal = digest_of("x"); });
  refused("[other-pack]", [](StudyCommitment& c) { c.pack = digest_of("x"); });
  refused("[other-configuration]", [](StudyCommitment& c) { c.configuration = "{}"; });
  CHECK(refusal_of([&] {
          StudyCommitment newer = lab_commitment();
          newer.program_version = "9.9";
          merge({a, lab.station("newer.db", {{"P3", 3, minutes(3)}}, newer)}, lab.file("C.db"));
        }).empty());
}

TEST_CASE("pilots on a screen are not pooled with pilots by hand") {
  Lab lab;
  StudyCommitment pilot = lab_commitment();
  pilot.pilot = true;
  const fs::path felt = lab.station("felt.db", {{"P1", 1, minutes(1)}}, pilot);
  const fs::path seen = lab.station("seen.db", {}, pilot);
  Lab::at(seen, [](StudyStore& store) {
    SessionOpening opening = opening_of({"P2", 2, {}}, store.commitment());
    opening.station.emplace().visual = true;
    store.add_session(session_of(1, 3, stroking(20, 0.05), opening), wrapped_key_of(1),
                      kUtc + minutes(2));
  });
  CHECK(names(merge_refusal(lab, {felt, seen}), "1"));
}

TEST_CASE("a participant id that was used at two stations is refused, and both are named") {
  TwoStations lab;
  const fs::path c = lab.station("D.db", {{"P8", 8, minutes(5)}, {"P3", 9, minutes(35)}});
  const std::string line = merge_refusal(lab, {lab.a, lab.b, c});
  CHECK(names_in_order(line, "P3 2 " + lab.a.string() + " 2 " + c.string()));
}

TEST_CASE("an enrolment number that was used at two stations is refused, and both are named") {
  TwoStations lab;
  const fs::path c = lab.station("D.db", {{"P9", 4, minutes(5)}});
  CHECK(names_in_order(merge_refusal(lab, {lab.a, lab.b, c}),
                       "4 P9 P4 1 " + c.string() + " 2 " + lab.b.string()));
}

TEST_CASE(
    "copies that each went on by themselves are refused, and the message says where they part") {
  TwoStations lab;
  const fs::path fork = lab.file("fork.db");
  fs::copy_file(lab.a, fork);
  Lab::at(lab.a, [](StudyStore& store) { visit(store, {{"P5", 5, minutes(50)}}); });
  Lab::at(fork, [](StudyStore& store) { visit(store, {{"P6", 6, minutes(50)}}); });
  const std::string line = merge_refusal(lab, {lab.a, lab.b, fork});
  CHECK(names_in_order(line, lab.a.string() + " " + fork.string() + " 5 3 P5"));
}

TEST_CASE("a collected file with decisions of its own is not collected again") {
  TwoStations lab;
  merge({lab.a, lab.b}, lab.file("C.db"));
  Lab::at(lab.file("C.db"), [](StudyStore& store) { store.exclude(1, kUtc, "fell asleep"); });
  CHECK(names_in_order(merge_refusal(lab, {lab.file("C.db"), lab.a}), "C.db participant-excluded"));
}

TEST_CASE("a collected study takes no sessions and no replacements") {
  TwoStations lab;
  merge({lab.a, lab.b}, lab.file("C.db"));
  StudyStore store = writable(lab.file("C.db"));
  CHECK(store.next_session() == 5);
  CHECK(refuses([&] { visit(store, {{"P7", 7, minutes(70)}}); }));
  CHECK(refuses([&] { begin(store, {"P7", 7, minutes(70)}); }));
  store.exclude(1, kUtc, "fell asleep");
  CHECK(refuses([&] { store.replace(1, "P7", kUtc, "excluded"); }));
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("a failing disk leaves no collected file, or a whole one") {
  TwoStations lab;
  for (const Fault::Kind kind : {Fault::Kind::full, Fault::Kind::error, Fault::Kind::short_write,
                                 Fault::Kind::kill, Fault::Kind::torn_kill}) {
    int refused = 0;
    for (std::int64_t at = 1;; at += 7) {
      FaultVfs vfs;
      Stations stations = stations_in({lab.a, lab.b});
      const fs::path target = lab.file("C.db");
      vfs.plan({.kind = kind, .at = at, .is_persistent = true});
      const std::string line = refusal_of([&] { collect_into_file(std::move(stations), target); });
      const bool has_occurred = vfs.has_occurred();
      const bool ended = kind == Fault::Kind::kill || kind == Fault::Kind::torn_kill;
      if (has_occurred && ended) vfs.restore_disk();
      vfs.repair();
      vfs.plan({});
      INFO("kind " << static_cast<int>(kind) << " at operation " << at << ": " << line);
      if (fs::exists(target)) {
        CHECK_FALSE(StudyStore::open(target, Access::read_only).first_fault());
      } else {
        REQUIRE_FALSE(line.empty());
        ++refused;
      }
      fs::remove(target);
      if (!has_occurred) break;
    }
    CHECK(refused > 3);
  }
}

TEST_CASE("after a power cut the collected file is whole if it is there") {
  TwoStations lab;
  FaultVfs vfs;
  const fs::path target = lab.file("C.db");
  vfs.plan({});
  merge({lab.a, lab.b}, target);
  // The file has its name, so its whole content must be on the disk.
  vfs.plan({.kind = Fault::Kind::power_cut, .at = 1});
  static_cast<void>(
      refusal_of([&] { writable(target).exclude(1, kUtc, "strikes the power cut"); }));
  REQUIRE(vfs.has_occurred());
  vfs.restore_disk();
  const StudyStore store = StudyStore::open(target, Access::read_only);
  CHECK(store.sessions().size() == 4);
  CHECK_FALSE(store.first_fault());
}

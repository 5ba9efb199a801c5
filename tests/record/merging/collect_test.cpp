// The content of a collected study.
#include "record/merging/lab_fixture.hpp"
#include "record/person_texts.hpp"
#include "support/catch.hpp"

#include <tuple>

using namespace touchtrial;
using namespace touchtrial::merging;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

using Names = std::vector<std::string>;

StudyStore merged(const Lab& lab, const std::vector<fs::path>& files,
                  const std::string& name = "C.db") {
  merge(files, lab.file(name));
  return StudyStore::open(lab.file(name), Access::read_only);
}

}  // namespace

TEST_CASE("sessions of several stations get numbers in the order in which they were opened") {
  TwoStations lab;
  const StudyStore store = merged(lab, {lab.a, lab.b});
  CHECK(store.stations() == 2);
  CHECK(participants_in(store) == Names{"P1", "P2", "P3", "P4"});
  std::vector<std::pair<int, int>> places;
  for (const SessionRow& row : store.sessions()) places.emplace_back(row.station, row.own_session);
  CHECK(places == std::vector<std::pair<int, int>>{{1, 1}, {2, 1}, {1, 2}, {2, 2}});
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("in simulated studies, whose times mean nothing, enrolment numbers decide") {
  Lab lab;
  const fs::path a =
      lab.station("A.db", {{"P3", 3, minutes(1)}, {"P4", 4, minutes(2)}}, commitment());
  const fs::path b =
      lab.station("B.db", {{"P1", 1, minutes(3)}, {"P2", 2, minutes(4)}}, commitment());
  CHECK(participants_in(merged(lab, {a, b})) == Names{"P1", "P2", "P3", "P4"});
}

TEST_CASE("a collected file depends on the stations' content alone, to the byte") {
  TwoStations lab;
  const fs::path c = lab.station("another name.db", {{"P5", 5, minutes(20)}});
  merge({lab.a, lab.b, c}, lab.file("abc.db"));
  merge({c, lab.b, lab.a}, lab.file("cba.db"));
  merge({lab.b, lab.a, c, lab.b}, lab.file("bacb.db"));
  CHECK(read_file(lab.file("abc.db")) == read_file(lab.file("cba.db")));
  CHECK(read_file(lab.file("abc.db")) == read_file(lab.file("bacb.db")));
}

TEST_CASE("events, traces and keys open as they did at the station") {
  TwoStations lab;
  const StudyStore store = merged(lab, {lab.a, lab.b});
  const StudyStore station = StudyStore::open(lab.b, Access::read_only);
  const SessionRow row = store.sessions().at(3);
  REQUIRE(row.own_session == 2);
  const auto key =
      unwrap_participant_key(box_keys(study_master()), 2, store.wrapped_key(4).value());
  REQUIRE(key == participant_key(2));
  CHECK_FALSE(unwrap_participant_key(box_keys(study_master()), 4, store.wrapped_key(4).value()));
  const std::vector<Event> here = store.events(4);
  const std::vector<Event> there = station.events(2);
  REQUIRE(here.size() == there.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    CHECK(here[i].session == 4);
    CHECK(here[i].hash == there[i].hash);
    CHECK(unsealed(here[i], *key) == unsealed(there[i], *key));
  }
  CHECK(unsealed(here.front(), *key) == R"({"schedule":"2"})");
  const SealedTrace sealed = store.sealed_trace(4, 3).value();
  CHECK(sealed == station.sealed_trace(2, 3).value());
  CHECK(unsealed_trace(sealed, *key));
}

TEST_CASE("the stations' own chains are kept as they were") {
  TwoStations lab;
  const StudyStore store = merged(lab, {lab.b, lab.a});
  int station = 0;
  for (const fs::path& path : {lab.a, lab.b}) {
    const std::vector<Event> theirs = StudyStore::open(path, Access::read_only).events(0);
    const std::vector<Event> kept = store.station_chain(++station);
    REQUIRE(kept.size() == theirs.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      CHECK(kept[i].session == 0);
      CHECK(kept[i].hash == theirs[i].hash);
      CHECK(event_hash(kept[i]) == theirs[i].hash);
    }
  }
  int openings = 0;
  store.for_each(EventKind::session_opened, [&](const Event& event) {
    CHECK(event.session == 0);
    ++openings;
  });
  CHECK(openings == 4);
}

TEST_CASE("derived tables of a collected study agree with its events") {
  TwoStations lab;
  Lab::at(lab.a, [](StudyStore& store) { store.exclude(1, kUtc, "fell asleep"); });
  merge({lab.a, lab.b}, lab.file("C.db"));
  const StudyStore store = StudyStore::open(lab.file("C.db"), Access::read_only);
  CHECK(store.sessions().at(0).excluded);
  CHECK(store.trials().size() == 12);
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("a participant who withdrew at a station remains withdrawn, and no key is collected") {
  TwoStations lab;
  Lab::at(lab.b, [](StudyStore& store) { store.withdraw(2, kUtc, "asked to"); });
  const StudyStore store = merged(lab, {lab.a, lab.b});
  CHECK(store.sessions().at(3).withdrawn);
  CHECK_FALSE(store.wrapped_key(4));
  CHECK(store.wrapped_key(2));
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("of two copies of a station's file the later one counts, with its withdrawal") {
  TwoStations lab;
  const fs::path early = lab.file("A as it was.db");
  fs::copy_file(lab.a, early);
  Lab::at(lab.a, [](StudyStore& store) {
    visit(store, {{"P5", 5, minutes(50)}});
    store.withdraw(1, kUtc, "asked to");
  });
  for (const std::vector<fs::path>& files :
       {std::vector<fs::path>{lab.a, lab.b, early}, std::vector<fs::path>{early, lab.b, lab.a}}) {
    const fs::path target = lab.file("C" + files.front().filename().string());
    const CollectReport report = merge(files, target);
    CHECK(report.stations == 2);
    CHECK(report.redundant == Names{early.string()});
    const StudyStore store = StudyStore::open(target, Access::read_only);
    CHECK(participants_in(store) == Names{"P1", "P2", "P3", "P4", "P5"});
    CHECK_FALSE(store.wrapped_key(1));
  }
}

TEST_CASE("what stations wrote about people, and looks at them, are collected and open as there") {
  TwoStations lab;
  Lab::at(lab.b, [](StudyStore& store) {
    store.note(2, kUtc + minutes(50), "no-curtain", "in the wash");
    store.look_at("P4", kUtc + minutes(51), "asked for the data");
    store.withdraw(2, kUtc + minutes(52), "moves away", Retention::data);
  });
  const StudyStore store = merged(lab, {lab.a, lab.b});
  CHECK(store.sessions().at(3).withdrawn);
  CHECK_FALSE(store.sessions().at(3).erased);
  CHECK(store.wrapped_keys(4) ==
        WrappedKeys{wrapped_key_of(2).participant, wrapped_key_of(2).safety});
  const PersonKeys keys{.participant = participant_key(2),
                        .safety = safety_key(participant_key(2))};
  std::vector<std::string> bodies;
  for (const Event& event : store.events(0)) {
    if (event.sealed.empty()) continue;
    CHECK_FALSE(opened_person_text(event, 4, keys));
    bodies.push_back(opened_person_text(event, 2, keys).value().body);
  }
  CHECK(bodies ==
        std::vector<std::string>{R"({"code":"no-curtain","session":4,"text":"in the wash"})",
                                 R"({"kept":"data","reason":"moves away","session":4})"});
  const StudyState state = store.state();
  CHECK_FALSE(state.unblinded);
  CHECK(state.looked_at == std::set<int>{4});
  CHECK(state.looks == std::vector<PersonLook>{{"P4", "asked for the data", kUtc + minutes(51)}});
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("sessions that have not ended are left out and reported") {
  TwoStations lab;
  Lab::at(lab.b, [](StudyStore& store) {
    begin(store, {"P5", 5, minutes(15)});
    store.exclude(3, kUtc, "an event about it");
    visit(store, {{"P6", 6, minutes(60)}});
  });
  const CollectReport report = merge({lab.a, lab.b}, lab.file("C.db"));
  REQUIRE(report.left_out.size() == 1);
  CHECK(report.left_out[0].station == lab.b.string());
  CHECK(report.left_out[0].session == 3);
  CHECK(report.left_out[0].participant == "P5");
  CHECK_FALSE(report.left_out[0].cut_short);
  const StudyStore store = StudyStore::open(lab.file("C.db"), Access::read_only);
  CHECK(participants_in(store) == Names{"P1", "P2", "P3", "P4", "P6"});
  CHECK(store.sessions().back().own_session == 4);
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("sessions that were replaced or withdrawn before they ended are reported apart") {
  TwoStations lab;
  Lab::at(lab.b, [](StudyStore& store) {
    begin(store, {"P5", 5, minutes(15)});
    begin(store, {"P6", 6, minutes(16)});
    begin(store, {"P7", 7, minutes(17)});
    store.exclude(3, kUtc, "the program crashed");
    store.replace(3, "P8", kUtc, "excluded");
    store.withdraw(4, kUtc, "asked to");
  });
  const CollectReport report = merge({lab.a, lab.b}, lab.file("C.db"));
  REQUIRE(report.left_out.size() == 3);
  CHECK(report.left_out[0].participant == "P5");
  CHECK(report.left_out[0].cut_short);
  CHECK(report.left_out[1].cut_short);
  CHECK_FALSE(report.left_out[2].cut_short);
  CHECK(report.sessions == 4);
}

TEST_CASE("files without sessions are reported, and if there are no others nothing is made") {
  TwoStations lab;
  const fs::path empty = lab.station("empty.db", {});
  CHECK(merge({lab.a, empty, lab.b}, lab.file("C.db")).redundant == Names{empty.string()});
  CHECK_FALSE(merge_refusal(lab, {empty}).empty());
}

TEST_CASE("a place that was taken over at another station does not clash, for any clocks") {
  TwoStations lab;
  Lab::at(lab.a, [](StudyStore& store) {
    store.exclude(1, kUtc + minutes(50), "fell asleep");
    store.replace(1, "P9", kUtc + minutes(50), "excluded");
  });
  // This station's clock is slow: the session seems to come before that which it replaces.
  const fs::path c = lab.station("C.db", {{"P9", 1, minutes(5)}});
  const StudyStore store = merged(lab, {c, lab.b, lab.a}, "all.db");
  CHECK(participants_in(store) == Names{"P1", "P2", "P3", "P4", "P9"});
  CHECK(store.sessions().at(0).replaced_by == "P9");
  CHECK(store.session_of("P9").value().session == 5);
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("two stations that each replaced one of a pair are merged, in either order") {
  Lab lab;
  const auto merged_replaced = [&](const fs::path& a, const fs::path& b) {
    for (const auto& [path, session, by] : {std::tuple(a, 1, "A03"), {b, 2, "B03"}}) {
      Lab::at(path, [&](StudyStore& store) {
        store.exclude(session, kUtc + minutes(50), "fell asleep");
        store.replace(session, by, kUtc + minutes(50), "excluded");
      });
    }
    return merged(lab, {a, b});
  };
  SECTION("by enrolment number") {
    const fs::path a = lab.station("A.db", {{"A01", 1, minutes(10)}, {"A02", 2, minutes(30)}});
    const fs::path b = lab.station("B.db", {{"B01", 1, minutes(20)}, {"B02", 2, minutes(40)}});
    const StudyStore store = merged_replaced(a, b);
    CHECK(participants_in(store) == Names{"A01", "A02", "B01", "B02"});
    CHECK(store.sessions().at(0).replaced_by == "A03");
    CHECK(store.sessions().at(3).replaced_by == "B03");
    CHECK_FALSE(store.first_fault());
    CHECK(merge({b, lab.file("C.db")}, lab.file("again.db")).sessions == 4);
    CHECK(read_file(lab.file("again.db")) == read_file(lab.file("C.db")));
    CHECK_FALSE(StudyStore::open(lab.file("C.db"), Access::read_only).first_fault());
  }
  SECTION("by participant id") {
    const fs::path a = lab.station("A.db", {{"P1", 1, minutes(10)}, {"P2", 2, minutes(30)}});
    const fs::path b = lab.station("B.db", {{"P1", 5, minutes(20)}, {"P2", 6, minutes(40)}});
    const StudyStore store = merged_replaced(a, b);
    CHECK(participants_in(store) == Names{"P1", "P2", "P1", "P2"});
    CHECK(store.session_of("P1").value().enrolment == 5);
    CHECK(store.session_of("P2").value().enrolment == 2);
    CHECK_FALSE(store.first_fault());
  }
  SECTION("in simulated studies, where times mean nothing") {
    StudyCommitment simulated = lab_commitment();
    simulated.simulated = true;
    const fs::path a = lab.station("A.db", {{"A01", 1, {}}, {"A02", 2, {}}}, simulated);
    const fs::path b = lab.station("B.db", {{"B01", 1, {}}, {"B02", 2, {}}}, simulated);
    const StudyStore store = merged_replaced(a, b);
    CHECK(store.sessions().size() == 4);
    CHECK_FALSE(store.first_fault());
    merge({b, a}, lab.file("again.db"));
    CHECK(read_file(lab.file("again.db")) == read_file(lab.file("C.db")));
  }
}

TEST_CASE("the successor of one of a pair collides with the other again") {
  Lab lab;
  const fs::path a = lab.station("A.db", {{"A01", 1, minutes(10)}, {"A02", 2, minutes(30)}});
  const fs::path b = lab.station("B.db", {{"B01", 1, minutes(20)}});
  CHECK(names_in_order(merge_refusal(lab, {a, b}), "1 A01 B01"));
  Lab::at(a, [](StudyStore& store) {
    store.exclude(1, kUtc + minutes(50), "wrong number");
    store.replace(1, "A03", kUtc + minutes(50), "wrong number");
  });
  CHECK(merge({a, b}, lab.file("C.db")).sessions == 3);
  Lab::at(a, [](StudyStore& store) { visit(store, {{"A03", 1, minutes(60)}}); });
  CHECK(
      names_in_order(merge_refusal(lab, {a, b}), "1 B01 A03 1 " + b.string() + " 3 " + a.string()));
}

TEST_CASE("the collected study is closed, and then unblinded, when every station's is") {
  TwoStations lab;
  Lab::at(lab.a, [](StudyStore& store) { store.close_study(kUtc + minutes(100)); });
  CHECK_FALSE(merged(lab, {lab.a, lab.b}, "open.db").state().closed);
  Lab::at(lab.b, [](StudyStore& store) { store.close_study(kUtc + minutes(90)); });
  {
    const StudyStore store = merged(lab, {lab.a, lab.b}, "closed.db");
    CHECK(store.state().closed);
    CHECK(store.last_event(0).value().at == kUtc + minutes(100));
  }
  Lab::at(lab.a, [](StudyStore& store) { store.unblind(kUtc, "done", false); });
  CHECK_FALSE(merged(lab, {lab.a, lab.b}, "one.db").state().unblinded);
  Lab::at(lab.b, [](StudyStore& store) { store.unblind(kUtc, "done too", false); });
  const StudyStore store = merged(lab, {lab.a, lab.b}, "both.db");
  CHECK(store.state().unblinded);
  CHECK_FALSE(store.state().interim);
  CHECK(store.state().unblinding_reason == "done; done too");
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("interim looks show the sessions of the stations' looks, and none after them") {
  TwoStations lab;
  Lab::at(lab.a, [](StudyStore& store) {
    store.unblind(kUtc, "a look", true);
    visit(store, {{"P5", 5, minutes(25)}});
  });
  CHECK_FALSE(merged(lab, {lab.a, lab.b}, "one.db").state().unblinded);
  Lab::at(lab.b, [](StudyStore& store) { store.unblind(kUtc, "a look", true); });
  const StudyStore store = merged(lab, {lab.a, lab.b}, "both.db");
  CHECK(participants_in(store) == Names{"P1", "P2", "P3", "P5", "P4"});
  const StudyState state = store.state();
  CHECK(state.unblinding_reason == "a look");
  CHECK(state.interim == std::set<int>{1, 2, 3, 5});
  CHECK_FALSE(state.shows(4));
  CHECK_FALSE(store.first_fault());
}

TEST_CASE("a station that still collects makes others' unblinding an interim look") {
  TwoStations lab;
  Lab::at(lab.a, [](StudyStore& store) {
    store.close_study(kUtc);
    store.unblind(kUtc, "done", false);
  });
  Lab::at(lab.b, [](StudyStore& store) { store.unblind(kUtc, "a look", true); });
  Lab::at(lab.b, [](StudyStore& store) { visit(store, {{"P6", 6, minutes(60)}}); });
  const StudyState state = merged(lab, {lab.a, lab.b}).state();
  CHECK_FALSE(state.closed);
  CHECK(state.interim == std::set<int>{1, 2, 3, 4});
}

TEST_CASE("a collected file can be collected again, with the same result") {
  TwoStations lab;
  const fs::path c = lab.station("D.db", {{"P5", 5, minutes(25)}});
  merge({lab.a, lab.b, c}, lab.file("at once.db"));
  merge({lab.a, lab.b}, lab.file("first.db"));
  merge({lab.file("first.db"), c}, lab.file("step by step.db"));
  merge({c, lab.file("first.db"), lab.a}, lab.file("twice.db"));
  CHECK(read_file(lab.file("step by step.db")) == read_file(lab.file("at once.db")));
  CHECK(read_file(lab.file("twice.db")) == read_file(lab.file("at once.db")));
  // A station that recorded more sessions since.
  Lab::at(lab.b, [](StudyStore& store) { visit(store, {{"P6", 6, minutes(60)}}); });
  merge({lab.a, lab.b, c}, lab.file("later.db"));
  merge({lab.file("at once.db"), lab.b}, lab.file("brought up.db"));
  CHECK(read_file(lab.file("brought up.db")) == read_file(lab.file("later.db")));
}

TEST_CASE("decisions are recorded in a collected study as in any other") {
  TwoStations lab;
  merge({lab.a, lab.b}, lab.file("C.db"));
  {
    StudyStore store = writable(lab.file("C.db"));
    store.exclude(2, kUtc, "fell asleep");
    store.note(3, kUtc, "no-masking-noise", "");
    store.withdraw(4, kUtc, "asked to");
    store.close_study(kUtc);
    store.unblind(kUtc, "done", false);
  }
  const StudyStore store = StudyStore::open(lab.file("C.db"), Access::read_only);
  CHECK_FALSE(store.first_fault());
  CHECK(store.sessions().at(1).excluded);
  CHECK(store.sessions().at(3).withdrawn);
  CHECK_FALSE(store.wrapped_key(4));
  CHECK(store.state().unblinded);
  CHECK_FALSE(store.state().interim);
}

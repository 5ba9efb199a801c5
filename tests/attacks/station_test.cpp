// Attacks by whoever holds a station's file: an experimenter, or somebody who copied it.
#include "analysis/text_matching.hpp"
#include "analysis/verification/verification.hpp"
#include "attacks/forger.hpp"
#include "core/errors.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;
using record::EventKind;
using std::chrono::seconds;

namespace {

/// Every key that a station's file leads to.
std::vector<SecretKey> keys_of(const study::StationKey& station) {
  std::vector<SecretKey> keys = {station.station.secret,
                                 box_keys(station.station.secret).secret_half};
  for (int number = 1; number <= 4; ++number) {
    keys.push_back(station.draw_of(number, study::Draws::people).secret);
  }
  return keys;
}

bool opens(const std::vector<record::Event>& events, const std::vector<SecretKey>& keys) {
  return std::ranges::any_of(events, [&](const record::Event& event) {
    return std::ranges::any_of(
        keys, [&](const SecretKey& key) { return record::opened_event(event, key).has_value(); });
  });
}

/// Everybody answers the first class.
FakeAnswers invented() {
  return [](const study::Trial&) { return 0; };
}

/// The program's own form of the database, with head files made anew from it.
void with_new_heads(AttackedStudy& study) {
  fs::remove(study.head());
  fs::remove(study.second_head());
  study.open();
}

}  // namespace

TEST_CASE("a station can drop a session and record another; any head out of its reach tells") {
  AttackedStudy study(0);
  const Digest on_paper = study.store().file_head().hash;
  study.close();
  Forgery forged(study.database());
  forged.drop(3);
  forged.write();
  const auto record_another = [&] {
    study.open();
    study.add({.participant = "P03", .enrolment = 3, .answers = invented()});
    study.close();
  };

  SECTION("all head files are in its reach") {
    fs::remove(study.second_head());
    fs::remove(study.head());
    record_another();
    CHECK(study.found().empty());
    note("a session replaced by the station, all head files with it", Outcome::possible);
    CHECK(names(study.found_by_head(on_paper), "[unknown-head]"));
    note("the same, held against a head on paper", Outcome::named);
  }
  SECTION("the second head file is not") {
    fs::remove(study.head());
    record_another();
    INFO(study.found());
    CHECK(contains(study.found(), study.second_head().string() + ": "));
    note("a session replaced by the station, but one head file", Outcome::named);
  }
}

TEST_CASE("a station can erase a look from its own file, and nothing else about a look") {
  AttackedStudy study;
  const Digest on_paper = study.store().file_head().hash;
  study.close();
  const Signer station = study.station().signer();
  Forgery forged(study.database());

  SECTION("erased") {
    forged.file().erase(forged.file().begin() + 4);
    forged.relink(&station);
    forged.write();
    CHECK(contains(study.found(), "heads: "));
    with_new_heads(study);
    study.close();
    CHECK(study.found().empty());
    note("a look erased by the station, all head files with it", Outcome::possible);
    CHECK(names(study.found_by_head(on_paper), "[unknown-head]"));
    note("the same, held against a head on paper", Outcome::named);
  }
  SECTION("an exclusion moved before it") {
    std::swap(forged.file()[4], forged.file()[5]);
    forged.relink(&station);
    forged.write();
    CHECK(names(study.found(), "chain: [unsigned-look]"));
    CHECK(names(study.found_without_key(), "chain: [unsigned-look]"));
    note("an exclusion moved before the look by the station", Outcome::named);
  }
  SECTION("another reason given for it") {
    set(forged.file()[4], "reason", "\"a technical check\"");
    forged.relink(&station);
    forged.write();
    CHECK(names(study.found(), "chain: [unsigned-look]"));
    note("a look's reason altered by the station", Outcome::named);
  }
}

TEST_CASE("a station can shift its clock") {
  AttackedStudy study;
  study.close();
  const Signer station = study.station().signer();
  Forgery forged(study.database());
  forged.file().resize(4);  // a look would have the investigator's signature of the true times
  for (int session = 2; session <= 4; ++session) forged.drop(session);
  for (record::Event& event : forged.file()) event.at += std::chrono::hours(1);
  forged.relink(&station);
  forged.write();
  with_new_heads(study);
  study.close();
  CHECK(study.found().empty());
  note("the station's own clock shifted", Outcome::possible);
}

TEST_CASE("a station cannot record a look") {
  AttackedStudy study;
  const std::string refusal = message_of<StoreError>(
      [&] { study.store().unblind(seconds(9), "curious", /*interim=*/true); });
  CHECK(names(refusal, "[needs-key]"));
  study.close();
  const Signer station = study.station().signer();
  Forgery forged(study.database());
  forged.file().push_back(forged.file()[4]);
  forged.relink(&station);
  forged.write();
  CHECK(names(study.found(), "chain: [unsigned-look]"));
  note("a look signed by the station", Outcome::named);
}

TEST_CASE("a station opens its open session, and none that has ended") {
  AttackedStudy study;
  const record::StudyStore& store = study.store();
  const std::vector<SecretKey> keys = keys_of(study.station());
  for (int session = 1; session <= 3; ++session) {
    CHECK_FALSE(store.kept_key(session));
    CHECK_FALSE(opens(store.events(session), keys));
    for (const SecretKey& key : keys) {
      CHECK_FALSE(record::unwrap_participant_key({study.station().investigator_box, key}, session,
                                                 store.wrapped_key(session).value()));
      CHECK_FALSE(record::unsealed_trace(store.sealed_trace(session, 1).value(), key).has_value());
    }
  }
  note("a session that has ended, opened with the station's file", Outcome::refused, 3);
  const auto kept =
      record::open_station_copy(study.station().station.secret, 4, store.kept_key(4).value());
  REQUIRE(kept);
  CHECK(opens(store.events(4), {*kept}));
  // Whoever keeps that key opens the session for ever.
  note("the open session, opened with the station's file", Outcome::possible);
}

TEST_CASE("a station's file draws its own participants' schedules, and no other station's") {
  const FakeStudy study(study::identification::classification(),
                        {.simulated = false, .stations = {"here", "there"}});
  const study::StationKey here = study::station_key(study.key(), "here");
  const study::StationKey there = study::station_key(study.key(), "there");
  const int theirs = there.station.ranges.front().first;
  const auto schedule = [&](const study::ScheduleDraw& draw) {
    return study::make_schedule(study.key().study, draw);
  };
  CHECK(schedule(here.draw_of(1, study::Draws::people)) ==
        schedule(study.key().draw_of(1, study::Draws::people)));
  note("one's own participants' schedules, with the station's file", Outcome::possible);
  CHECK_FALSE(message_of<UsageError>([&] {
                static_cast<void>(here.draw_of(theirs, study::Draws::people));
              }).empty());
  study::Station posing = here.station;
  posing.name = "there";
  posing.ranges = there.station.ranges;
  for (int number = theirs; number <= there.station.ranges.front().last; ++number) {
    CHECK_FALSE(schedule(draw_for(here.study, posing, number, study::Draws::people)) ==
                schedule(there.draw_of(number, study::Draws::people)));
  }
  note("another station's schedules", Outcome::refused);
}

TEST_CASE("a station signs for no other, and passes no other's session off as its own") {
  FakeStudy study(study::identification::classification(),
                  {.simulated = false, .stations = {"here", "there"}});
  const study::StationKey there = study::station_key(study.key(), "there");
  const Signer other = there.signer();
  CHECK(names(message_of<StoreError>([&] { study.store().sign_with(other); }),
              "here [other-station]"));
  study.store().sign_with(study::station_key(study.key(), "here").signer());
  study.add({.participant = "P01", .enrolment = 1, .answers = FakeStudy::always_right()});
  { const record::StudyStore closed = std::move(study.store()); }

  Forgery forged(study.database());
  forged.relink(&other);
  forged.write();
  const auto faults = [&] {
    const record::StudyStore store =
        record::StudyStore::open(study.database(), record::StudyStore::Access::read_only);
    std::string failed;
    for (const analysis::Check& check :
         analysis::verify_study(store, &study.key(), nullptr).checks) {
      if (check.state == analysis::CheckState::failed) failed += check.name + ": " + check.detail;
    }
    return failed;
  };
  CHECK(names(faults(), "[unsigned]"));
  note("a file signed by another station", Outcome::named);

  set(forged.file().front(), "station",
      R"({"name": "there", "key": ")" + to_hex(other.public_half()) + R"(", "certificate": ")" +
          to_hex(there.certificate) + "\"}");
  forged.relink(&other);
  forged.write();
  INFO(faults());
  CHECK(names_in_order(faults(), "1 1 here there"));
  note("another station's session passed off as one's own", Outcome::named);
}

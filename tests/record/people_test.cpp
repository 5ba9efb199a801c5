#include "core/files.hpp"
#include "record/damage.hpp"
#include "record/file_chain.hpp"
#include "record/payload_json.hpp"
#include "record/person_texts.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <thread>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

BufferedEvents stopped_session(int session, const SessionOpening& how) {
  BufferedEvents events;
  SessionRecorder recorder(session, participant_key(session), events);
  recorder.opened(nanoseconds(0), how, "{}");
  recorder.add(seconds(1), EventKind::stopped, StopBody{.text = "left"});
  recorder.closed(seconds(1), false);
  return events;
}

SessionOpening opening_of(int session, const std::string& participant, int enrolment) {
  SessionOpening how = opening(session);
  how.participant = participant;
  how.enrolment = enrolment;
  return how;
}

void add_stopped(StudyStore& store, int session, const std::string& participant, int enrolment) {
  store.add_session(stopped_session(session, opening_of(session, participant, enrolment)),
                    wrapped_key_of(session), kUtc);
}

void add_complete(StudyStore& store, int session, const std::string& participant, int enrolment) {
  store.add_session(
      session_of(session, 2, stroking(20, 0.05), opening_of(session, participant, enrolment)),
      wrapped_key_of(session), kUtc);
}

PersonKeys all_keys(int session) {
  return {.participant = participant_key(session), .safety = safety_key(participant_key(session))};
}

/// The bodies of the events about session 1, as far as these keys open them.
std::vector<std::string> texts_of(const StudyStore& store, const PersonKeys& keys) {
  std::vector<std::string> bodies;
  for (const Event& event : store.events(0)) {
    if (event.sealed.empty() || session_about(event) != 1) continue;
    if (const auto opened = opened_person_text(event, 1, keys)) bodies.push_back(opened->body);
  }
  return bodies;
}

}  // namespace

TEST_CASE("only the successor of a replaced participant inherits the enrolment number") {
  StoredFixture study(1);
  StudyStore& store = *study.store;
  add_stopped(store, 2, "P2", 2);
  store.replace(2, "P21", kUtc, "left after two trials");
  REQUIRE(store.sessions().at(1).replaced_by == "P21");
  REQUIRE(store.enrolment_for("P21") == 2);
  REQUIRE(store.next_enrolment() == 3);
  REQUIRE(store.enrolment_for("P3") == 3);
  REQUIRE_FALSE(store.session_of("P2"));
  REQUIRE(store.sessions_of("P2").size() == 1);
  REQUIRE(refuses([&] { add_complete(store, 3, "P3", 2); }, "P21"));
  REQUIRE(refuses([&] { add_complete(store, 3, "P21", 3); }, "P21"));
  REQUIRE(refuses([&] { add_complete(store, 3, "P2", 3); }, "P2"));
  add_complete(store, 3, "P21", 2);
  REQUIRE(store.session_of("P21").value().session == 3);
  REQUIRE(store.next_enrolment() == 3);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("a place can change hands again and again") {
  StoredFixture study;
  StudyStore& store = *study.store;
  add_stopped(store, 1, "P1", 1);
  store.replace(1, "P1", kUtc, "restarted");
  REQUIRE(store.enrolment_for("P1") == 1);
  add_stopped(store, 2, "P1", 1);
  store.replace(2, "P2", kUtc, "left");
  REQUIRE(store.enrolment_for("P2") == 1);
  REQUIRE(refuses([&] { add_stopped(store, 3, "P1", 1); }, "P2"));
  add_complete(store, 3, "P2", 1);
  REQUIRE(store.sessions_of("P1").size() == 2);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("only a participant who cannot continue is replaced, once, and by a new one") {
  StoredFixture study(2);
  StudyStore& store = *study.store;
  const auto refusal = [&](int session, const std::string& by, const std::string& reason = "left") {
    return refusal_of([&] { store.replace(session, by, kUtc, reason); });
  };
  REQUIRE(names(refusal(1, "P9"), "1 P1"));
  store.exclude(1, kUtc, "fell asleep");
  REQUIRE_FALSE(refusal(1, "P9", "").empty());
  REQUIRE(names_in_order(refusal(1, "P 9"), "P 9"));
  REQUIRE(names(refusal(1, "P2"), "P2 2"));
  REQUIRE(names(refusal(7, "P9"), "7"));
  REQUIRE(refusal(1, "P9").empty());
  REQUIRE(names(refusal(1, "P8"), "1 P1"));
  store.withdraw(2, kUtc, "asked to");
  REQUIRE(names(refusal(2, "P9"), "P9"));
  store.close_study(kUtc);
  REQUIRE_FALSE(refusal(2, "P8").empty());
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("an open session is replaced only if it was excluded, and then cannot continue") {
  StoredFixture study;
  StudyStore& store = *study.store;
  const auto sink = store.begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  REQUIRE(refuses([&] { store.replace(1, "P9", kUtc, "left"); }));
  store.exclude(1, kUtc, "left after the power cut");
  store.replace(1, "P9", kUtc, "left");
  REQUIRE(refuses([&] { (void)store.continue_session(1); }, "P9"));
  REQUIRE(refuses([&] { recorder.presented(seconds(1), 1, 0); }, "P1"));
  recorder.closed(seconds(2), false);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("a note on a participant stands on the file's chain, with its code") {
  StoredFixture study(1);
  StudyStore& store = *study.store;
  store.note(1, kUtc, "no-masking-noise", "headphones broken");
  const NoteBody note = from_json<NoteBody>(store.last_event(0).value().body);
  REQUIRE(note.session == 1);
  REQUIRE(note.code == "no-masking-noise");
  REQUIRE(note.text.empty());  // sealed
  REQUIRE(texts_of(store, all_keys(1)).back() ==
          R"({"code":"no-masking-noise","session":1,"text":"headphones broken"})");
  REQUIRE(refuses([&] { store.note(1, kUtc, "", ""); }));
  REQUIRE(refuses([&] { store.note(2, kUtc, "", "x"); }, "2"));
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("all sessions of a participant withdraw together or none does") {
  StoredFixture study;
  StudyStore& store = *study.store;
  add_stopped(store, 1, "P1", 1);
  store.replace(1, "P1", kUtc, "restarted");
  add_complete(store, 2, "P1", 1);
  const std::vector<int> unknown = {1, 7};
  REQUIRE_FALSE(refusal_of([&] { store.withdraw(unknown, kUtc, "asked to"); }).empty());
  REQUIRE(store.wrapped_key(1));
  const std::vector<int> both = {1, 2};
  store.withdraw(both, kUtc, "asked to");
  REQUIRE_FALSE(store.wrapped_key(1));
  REQUIRE_FALSE(store.wrapped_key(2));
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("a file's chain on which two sessions have one participant or number is refused") {
  StoredFixture study(1);
  FileChain chain;
  for (const Event& event : study.store->events(0)) chain.add(event);
  const auto opened = [](const std::string& participant, int enrolment) {
    Event event;
    event.sequence = 3;
    event.kind = EventKind::session_opened;
    event.body = to_json(SessionOpenedBody{
        .session = 2, .participant = participant, .enrolment = enrolment, .first = {}, .key = {}});
    return event;
  };
  REQUIRE(refuses([&] { chain.add(opened("P1", 2)); }));
  FileChain other;
  for (const Event& event : study.store->events(0)) other.add(event);
  REQUIRE(refuses([&] { other.add(opened("P2", 1)); }, "1"));
  // On a collected study's chain only the final state must be unique; the code that collects the
  // study ensures it.
  FileChain collected(UniquePlaces::at_end);
  for (const Event& event : study.store->events(0)) collected.add(event);
  collected.add(opened("P1", 1));
  REQUIRE(collected.sessions().size() == 2);
}

TEST_CASE("what is written about a person opens with that person's keys alone") {
  StoredFixture study(2);
  StudyStore& store = *study.store;
  store.note(1, kUtc, "", "tall, with a limp");
  store.note(1, kUtc, "no-curtain", "in the wash");
  store.exclude(1, kUtc, "drunk");
  store.replace(1, "P9", kUtc, "sent home");
  store.withdraw(1, kUtc, "moves away", Retention::data);
  const std::vector<std::string> expected = {
      R"({"code":"","session":1,"text":"tall, with a limp"})",
      R"({"code":"no-curtain","session":1,"text":"in the wash"})",
      R"({"reason":"drunk","session":1})", R"({"by":"P9","reason":"sent home","session":1})",
      R"({"kept":"data","reason":"moves away","session":1})"};
  REQUIRE(texts_of(store, all_keys(1)) == expected);
  // The safety key opens all but the remark, and the participant's key the remark alone.
  const PersonKeys safety{.participant = {}, .safety = all_keys(1).safety};
  REQUIRE(texts_of(store, safety) ==
          std::vector<std::string>(expected.begin() + 1, expected.end()));
  const PersonKeys own{.participant = participant_key(1), .safety = {}};
  REQUIRE(texts_of(store, own) == std::vector<std::string>{expected.front()});
  REQUIRE(texts_of(store, all_keys(2)).empty());
  // No text lies in the file in clear, and equal texts look different.
  store.note(2, kUtc, "", "tall, with a limp");
  REQUIRE(store.last_event(0)->sealed.size() == store.events(0)[5].sealed.size());
  REQUIRE(store.last_event(0)->sealed != store.events(0)[5].sealed);
  REQUIRE_FALSE(store.first_fault());
  study.store.reset();
  const Bytes file = read_file(study.path);
  for (const std::string words : {"limp", "wash", "drunk", "sent home", "moves away"}) {
    const ByteView sought = bytes_of(words);
    REQUIRE(std::search(file.begin(), file.end(), sought.begin(), sought.end()) == file.end());
  }
}

TEST_CASE("a sealed text is bound to its event and its session") {
  StoredFixture study(1);
  study.store->note(1, kUtc, "no-curtain", "in the wash");
  const Event stored = study.store->last_event(0).value();
  REQUIRE(opened_person_text(stored, 1, all_keys(1)));
  REQUIRE_FALSE(opened_person_text(stored, 2, all_keys(1)));
  Event moved = stored;
  moved.at += nanoseconds(1);
  REQUIRE_FALSE(opened_person_text(moved, 1, all_keys(1)));
  moved = stored;
  moved.kind = EventKind::participant_excluded;
  REQUIRE_FALSE(opened_person_text(moved, 1, all_keys(1)));
  moved = stored;
  moved.sealed.back() ^= 1U;
  REQUIRE_FALSE(opened_person_text(moved, 1, all_keys(1)));
}

TEST_CASE("a withdrawn participant's data can be kept, then erased, but not restored") {
  StoredFixture study(2);
  StudyStore& store = *study.store;
  store.withdraw(1, kUtc, "moves away", Retention::data);
  REQUIRE(store.sessions()[0].withdrawn);
  REQUIRE_FALSE(store.sessions()[0].erased);
  REQUIRE(store.wrapped_keys(1) ==
          WrappedKeys{wrapped_key_of(1).participant, wrapped_key_of(1).safety});
  REQUIRE(refuses([&] { store.withdraw(1, kUtc, "again", Retention::data); }));
  REQUIRE_FALSE(store.first_fault());
  store.withdraw(1, kUtc, "changed her mind");
  REQUIRE(store.sessions()[0].erased);
  REQUIRE_FALSE(store.wrapped_key(1));
  REQUIRE(store.wrapped_keys(1).safety == wrapped_key_of(1).safety);
  for (const Retention kept : {Retention::data, Retention::safety_record}) {
    REQUIRE(refuses([&] { store.withdraw(1, kUtc, "again", kept); }));
  }
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("of an open session whose participant withdraws only the end is recorded") {
  const Retention kept = GENERATE(Retention::data, Retention::safety_record);
  StoredFixture study;
  StudyStore& store = *study.store;
  const auto sink = store.begin_session(1, wrapped_key_of(1), {}, Bytes{1, 2});
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  store.withdraw(1, kUtc, "moves away", kept);
  REQUIRE_FALSE(store.kept_key(1));
  REQUIRE_FALSE(store.first_fault());
  REQUIRE(refuses([&] { (void)store.continue_session(1); }));
  REQUIRE(refuses([&] { recorder.presented(seconds(1), 1, 0); }, "P1"));
  recorder.add(seconds(2), EventKind::stopped, StopBody{.code = "", .text = "moves away"});
  recorder.closed(seconds(2), false);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("a safety record is kept for as many years as the study says, to the day") {
  StoredFixture study(1);  // on 14 November 2023, kept for ten years
  StudyStore& store = *study.store;
  const auto erase = [&](nanoseconds at) {
    return refusal_of([&] { store.withdraw(1, at, "", Retention::nothing); });
  };
  constexpr std::chrono::days kTenYears(10 * 365 + 3);  // 2024, 2028 and 2032 are leap years
  REQUIRE_FALSE(erase(kUtc + kTenYears).empty());
  store.withdraw(1, kUtc, "asked to");
  REQUIRE(names(erase(kUtc), "2033-11-14"));
  REQUIRE(names(erase(kUtc + kTenYears - nanoseconds(1)), "2033-11-14"));
  REQUIRE(store.wrapped_keys(1).safety);
  REQUIRE(erase(kUtc + kTenYears).empty());
  REQUIRE(store.wrapped_keys(1) == WrappedKeys{});
  REQUIRE_FALSE(erase(kUtc + kTenYears).empty());
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("of an erased person only the safety record can be opened, until it is erased too") {
  StoredFixture study;
  StudyStore& store = *study.store;
  const SecretKey station = digest_of("station");
  {
    const auto sink = store.begin_session(
        1, wrapped_key_of(1), [] { return kUtc; },
        seal_station_copy(station, 1, participant_key(1)));
    SessionRecorder recorder(1, participant_key(1), *sink);
    record_trials(recorder, 1, 3, stroking(20, 0.05), opening(1));
  }
  store.note(1, kUtc, "", "tall, with a limp");
  store.note(1, kUtc, "no-curtain", "in the wash");
  add(store, 2);
  store.withdraw(1, kUtc, "asked to");
  study.store.reset();
  study.store = StudyStore::open(study.path, StudyStore::Access::read_only);

  // The attacker has the file, the investigator's keys and the station's secret, and tries every
  // key that follows from them, and every row of every table that holds keys.
  const BoxKeys investigator = box_keys(study_master());
  std::vector<SecretKey> keys = {study_master(), investigator.secret_half, station,
                                 derive_key(station, "participant keys"), participant_key(2)};
  const SecretKey safety =
      unwrap_safety_key(investigator, 1, study.store->wrapped_keys(1).safety.value()).value();
  for (const char* const purpose : {"safety", "reasons", "remarks", "nonce", "cipher"}) {
    keys.push_back(derive_key(safety, purpose));
  }
  keys.push_back(safety);
  REQUIRE_FALSE(study.store->wrapped_key(1));
  REQUIRE_FALSE(study.store->kept_key(1));
  for (const SecretKey& key : keys) {
    for (const Event& event : study.store->events(1)) {
      REQUIRE_FALSE(opened_event(event, key));
      REQUIRE_FALSE(unseal(key, "", event.sealed, 1));
    }
    for (int trial = 1; trial <= 3; ++trial) {
      REQUIRE_FALSE(unsealed_trace(study.store->sealed_trace(1, trial).value(), key));
    }
    for (const std::string& text : texts_of(*study.store, {.participant = key, .safety = {}})) {
      REQUIRE_FALSE(contains(text, "limp"));
    }
    for (const Bytes& wrapped : {study.store->wrapped_keys(1).safety.value()}) {
      REQUIRE_FALSE(unwrap_participant_key(box_keys(key), 1, wrapped));
    }
  }
  const PersonKeys left{.participant = {}, .safety = safety};
  REQUIRE(texts_of(*study.store, left) ==
          std::vector<std::string>{R"({"code":"no-curtain","session":1,"text":"in the wash"})",
                                   R"({"kept":"safety-record","reason":"asked to","session":1})"});
  // The pages that held the key hold it no more, nor does anything beside the file.
  study.store.reset();
  const Bytes wrapped = wrapped_key_of(1).participant;
  const Bytes file = read_file(study.path);
  REQUIRE(std::search(file.begin(), file.end(), wrapped.begin(), wrapped.begin() + 16) ==
          file.end());
}

TEST_CASE("a look sees the session that begins while it waits for the database") {
  StoredFixture study(2);
  StudyStore other = writable(study.path);
  std::string said;
  std::thread look;
  // The clock is asked inside the transaction that stores the opening.
  const auto sink = study.store->begin_session(3, wrapped_key_of(3), [&] {
    look = std::thread([&] { said = refusal_of([&] { other.look_at("P3", kUtc, "asked"); }); });
    std::this_thread::sleep_for(milliseconds(200));  // enough to read too early
    return kUtc;
  });
  SessionRecorder recorder(3, participant_key(3), *sink);
  recorder.opened(nanoseconds(0), opening(3), "{}");
  look.join();
  REQUIRE_FALSE(said.empty());
}

TEST_CASE("a look at one participant shows the sessions of that participant so far") {
  StoredFixture study(2);
  StudyStore& store = *study.store;
  const auto refusal = [&](const std::string& participant, const std::string& reason) {
    return refusal_of([&] { store.look_at(participant, kUtc, reason); });
  };
  REQUIRE_FALSE(refusal("P1", "").empty());
  REQUIRE(names(refusal("P9", "asked"), "P9"));
  REQUIRE(refusal("P1", "asked").empty());
  REQUIRE_FALSE(store.state().unblinded);
  REQUIRE(store.state().shows(1));
  REQUIRE_FALSE(store.state().reports(1));
  REQUIRE_FALSE(store.state().shows(2));
  REQUIRE(store.state().looks == std::vector<PersonLook>{{"P1", "asked", kUtc}});
  const auto sink = store.begin_session(3, wrapped_key_of(3));
  SessionRecorder recorder(3, participant_key(3), *sink);
  recorder.opened(nanoseconds(0), opening(3), "{}");
  REQUIRE_FALSE(refusal("P3", "asked").empty());
  store.withdraw(2, kUtc, "asked to");
  REQUIRE_FALSE(refusal("P2", "asked").empty());
  store.exclude(1, kUtc, "bad figures");
  REQUIRE(from_json<ParticipantBody>(store.last_event(0)->body).after_outcomes);
  store.close_study(kUtc);
  REQUIRE(refusal("P1", "asked again").empty());
  store.unblind(kUtc, "planned", false);
  REQUIRE(store.state().reports(1));
  REQUIRE(store.state().looks.size() == 2);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("a file's chain that brings erased data back, or erases them twice, is refused") {
  StoredFixture study(1);
  FileChain chain;
  for (const Event& event : study.store->events(0)) chain.add(event);
  const auto add = [&](Retention kept) {
    Event event;
    event.sequence = 3;
    event.kind = EventKind::participant_withdrawn;
    event.body = to_json(WithdrawalBody{.session = 1, .kept = kept, .reason = ""});
    return refusal_of([&] { chain.add(event); });
  };
  REQUIRE_FALSE(add(Retention::nothing).empty());
  REQUIRE(add(Retention::data).empty());
  REQUIRE(add(Retention::safety_record).empty());
  REQUIRE_FALSE(add(Retention::data).empty());
  REQUIRE_FALSE(add(Retention::safety_record).empty());
  REQUIRE(add(Retention::nothing).empty());
}

TEST_CASE("a second visit follows a complete one of the same participant and number") {
  StoredFixture study;
  StudyStore& store = *study.store;
  const auto visit_of = [](int session, const std::string& participant, int enrolment, int visit) {
    SessionOpening how = opening_of(session, participant, enrolment);
    how.visit = visit;
    return how;
  };
  const auto add = [&](int session, const std::string& participant, int enrolment, int visit) {
    store.add_session(session_of(session, 2, stroking(20, 0.05),
                                 visit_of(session, participant, enrolment, visit)),
                      wrapped_key_of(session), kUtc);
  };
  REQUIRE(refuses([&] { add(1, "P1", 1, 2); }, "2"));
  add(1, "P1", 1, 1);
  REQUIRE(refuses([&] { add(2, "P1", 1, 1); }, "1"));
  REQUIRE(refuses([&] { add(2, "P1", 1, 3); }, "1"));
  REQUIRE(refuses([&] { add(2, "P1", 2, 2); }, "1"));
  REQUIRE(refuses([&] { add(2, "P2", 1, 2); }, "P1"));
  add(2, "P1", 1, 2);
  REQUIRE(store.sessions().at(1).visit == 2);
  REQUIRE(store.session_of("P1").value().session == 2);
  REQUIRE(store.sessions_of("P1").size() == 2);
  store.add_session(stopped_session(3, visit_of(3, "P1", 1, 3)), wrapped_key_of(3), kUtc);
  REQUIRE(refuses([&] { add(4, "P1", 1, 4); }, "3"));
  // The visit is begun again under the same number.
  store.replace(3, "P1", kUtc, "restarted");
  add(4, "P1", 1, 3);
  REQUIRE(store.next_enrolment() == 2);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("a replacement applies to all visits") {
  StoredFixture study;
  StudyStore& store = *study.store;
  add_complete(store, 1, "P1", 1);
  SessionOpening again = opening_of(2, "P1", 1);
  again.visit = 2;
  store.add_session(stopped_session(2, again), wrapped_key_of(2), kUtc);
  store.replace(2, "P9", kUtc, "moved away");
  for (const SessionRow& row : store.sessions()) REQUIRE(row.replaced_by == "P9");
  REQUIRE(store.enrolment_for("P9") == 1);
  REQUIRE_FALSE(store.session_of("P1"));
  add_complete(store, 3, "P9", 1);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("on a file's chain a visit follows a complete one") {
  StoredFixture study;
  add_complete(*study.store, 1, "P1", 1);
  const std::vector<Event> chain = study.store->events(0);
  FileChain file;
  for (const Event& event : chain) file.add(event);
  const auto opened = [&](const std::string& participant, int enrolment, int visit) {
    Event event = chain.back();
    event.sequence += 1;
    event.kind = EventKind::session_opened;
    event.body = to_json(SessionOpenedBody{.session = 2,
                                           .participant = participant,
                                           .enrolment = enrolment,
                                           .visit = visit,
                                           .first = {},
                                           .key = {}});
    FileChain longer = file;
    longer.add(event);
  };
  REQUIRE_NOTHROW(opened("P1", 1, 2));
  REQUIRE_THROWS_AS(opened("P1", 1, 3), EventFault);
  REQUIRE_THROWS_AS(opened("P1", 2, 2), EventFault);
  REQUIRE_THROWS_AS(opened("P2", 1, 2), EventFault);
  REQUIRE_THROWS_AS(opened("P1", 1, 1), EventFault);
}

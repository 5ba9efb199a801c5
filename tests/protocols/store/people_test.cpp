#include "protocols/store/file_chain.hpp"
#include "protocols/store/payload_json.hpp"
#include "protocols/store/store_fixture.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

BufferedEvents stopped_session(int session, const SessionOpening& how) {
  BufferedEvents events;
  SessionRecorder recorder(session, participant_key(session), events);
  recorder.opened(nanoseconds(0), how, "{}");
  recorder.remarked(seconds(1), EventKind::stopped, "left");
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

}  // namespace

TEST_CASE(
    "the successor of a replaced participant inherits the enrolment number, and nobody else does") {
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
  REQUIRE(contains(refusal_of([&] { add_complete(store, 3, "P3", 2); }),
                   "enrolment 2 is kept for participant P21"));
  REQUIRE(contains(refusal_of([&] { add_complete(store, 3, "P21", 3); }),
                   "participant P21 replaces somebody and inherits enrolment 2"));
  REQUIRE(contains(refusal_of([&] { add_complete(store, 3, "P2", 3); }),
                   "participant P2 was replaced by participant P21 (session 2)"));
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
  REQUIRE(contains(refusal_of([&] { add_stopped(store, 3, "P1", 1); }), "kept for participant P2"));
  add_complete(store, 3, "P2", 1);
  REQUIRE(store.sessions_of("P1").size() == 2);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("only a participant who cannot go on is replaced, once, and by somebody new") {
  StoredFixture study(2);
  StudyStore& store = *study.store;
  const auto refusal = [&](int session, const std::string& by, const std::string& reason = "left") {
    return refusal_of([&] { store.replace(session, by, kUtc, reason); });
  };
  REQUIRE(contains(refusal(1, "P9"), "session 1 (participant P1) is complete"));
  store.exclude(1, kUtc, "did not follow the instructions");
  REQUIRE(contains(refusal(1, "P9", ""), "a replacement needs a reason"));
  REQUIRE(contains(refusal(1, "P 9"), "'P 9' is no participant id"));
  REQUIRE(contains(refusal(1, "P2"), "participant P2 already has session 2"));
  REQUIRE(contains(refusal(7, "P9"), "there is no session 7"));
  REQUIRE(refusal(1, "P9").empty());
  REQUIRE(contains(refusal(1, "P8"), "session 1 (participant P1) was already replaced"));
  store.withdraw(2, kUtc, "asked to");
  REQUIRE(contains(refusal(2, "P9"), "participant P9 already replaces somebody"));
  store.close_study(kUtc);
  REQUIRE(contains(refusal(2, "P8"), "the study is closed"));
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("an open session is replaced only if it was excluded, and then cannot go on") {
  StoredFixture study;
  StudyStore& store = *study.store;
  const auto sink = store.begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  REQUIRE(contains(refusal_of([&] { store.replace(1, "P9", kUtc, "left"); }), "is still open"));
  store.exclude(1, kUtc, "left after the power cut");
  store.replace(1, "P9", kUtc, "left");
  REQUIRE(contains(refusal_of([&] { (void)store.continue_session(1); }),
                   "it was replaced by participant P9"));
  REQUIRE(contains(refusal_of([&] { recorder.presented(seconds(1), 1, 0); }),
                   "participant P1 was replaced by participant P9; end session 1"));
  recorder.closed(seconds(2), false);
  REQUIRE_FALSE(store.first_fault());
}

TEST_CASE("a note on a participant stands on the file's chain, with its code") {
  StoredFixture study(1);
  StudyStore& store = *study.store;
  store.note(1, kUtc, "no-masking-noise", "headphones broken");
  const NoteBody note = note_from_json(store.last_event(0).value().body);
  REQUIRE(note.session == 1);
  REQUIRE(note.code == "no-masking-noise");
  REQUIRE(note.text == "headphones broken");
  REQUIRE(contains(refusal_of([&] { store.note(1, kUtc, "", ""); }), "the note is empty"));
  REQUIRE(contains(refusal_of([&] { store.note(2, kUtc, "", "x"); }), "there is no session 2"));
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
  REQUIRE(contains(refusal_of([&] { chain.add(opened("P1", 2)); }), "has a session already"));
  FileChain other;
  for (const Event& event : study.store->events(0)) other.add(event);
  REQUIRE(contains(refusal_of([&] { other.add(opened("P2", 1)); }), "enrolment 1 is taken"));
  // On a collected study's chain only the final state must be unique; the code that collects the
  // study ensures it.
  FileChain collected(UniquePlaces::in_the_end);
  for (const Event& event : study.store->events(0)) collected.add(event);
  collected.add(opened("P1", 1));
  REQUIRE(collected.sessions().size() == 2);
}

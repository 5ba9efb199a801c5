#include "protocols/store/store_fixture.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::store;
using namespace touchtrial::fixture;

namespace {

UtcClock clock_at(nanoseconds utc) {
  return [utc] { return utc; };
}

}  // namespace

TEST_CASE("a session stored event by event equals one stored whole") {
  StoredFixture whole(1);
  StoredFixture live;
  const auto sink = live.store->begin_session(1, wrapped_key_of(1), clock_at(kUtc));
  SessionRecorder recorder(1, participant_key(1), *sink);
  record(recorder, 1, 3, stroking(20, 0.05), opening(1));

  for (const int chain : {0, 1}) {
    const auto expected = whole.store->events(chain);
    const auto stored = live.store->events(chain);
    REQUIRE(stored.size() == expected.size());
    REQUIRE(stored.back().hash == expected.back().hash);
  }
  REQUIRE(live.store->sessions() == whole.store->sessions());
  REQUIRE(live.store->trials() == whole.store->trials());
  REQUIRE(live.store->sealed_trace(1, 2) == whole.store->sealed_trace(1, 2));
  REQUIRE_FALSE(live.store->first_fault());
}

TEST_CASE("every accepted event is in the file at once, for other programs too") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  const StudyStore reader = StudyStore::open(study.path, StudyStore::Access::read_only);
  REQUIRE(reader.sessions().at(0).state == SessionState::open);
  recorder.presented(seconds(1), 1, 0);
  REQUIRE(reader.events(1).size() == 2);
  REQUIRE(reader.trials().at(0).state == TrialState::presented);
  recorder.answered(seconds(2),
                    {.trial = 1, .position = 3, .first_position = {}, .confidence = {}});
  REQUIRE(reader.trials().at(0).position == 3);
  REQUIRE_FALSE(reader.first_fault());
}

TEST_CASE("a session that breaks off stays open and is no fault") {
  StoredFixture study;
  {
    const auto sink = study.store->begin_session(1, wrapped_key_of(1));
    SessionRecorder recorder(1, participant_key(1), *sink);
    recorder.opened(nanoseconds(0), opening(1), "{}");
    recorder.presented(seconds(1), 1, 0);
  }
  study.store.reset();
  study.store = StudyStore::open(study.path, StudyStore::Access::read_write);
  REQUIRE(study.store->sessions().at(0).state == SessionState::open);
  REQUIRE(study.store->next_session() == 2);
  REQUIRE_FALSE(study.store->first_fault());
  add(*study.store, 2);
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("a refused event leaves no mark, and the session goes on") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  REQUIRE(
      contains(refusal_of([&] { recorder.presented(seconds(1), 1, 0); }), "begins with 'opened'"));
  REQUIRE(study.store->events(0).size() == 1);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  const AnswerBody answer{.trial = 1, .position = 3, .first_position = {}, .confidence = {}};
  REQUIRE(contains(refusal_of([&] { recorder.answered(seconds(2), answer); }),
                   "session 1, event 1: trial 1 has not been presented"));
  REQUIRE(study.store->events(1).size() == 1);
  recorder.presented(seconds(1), 1, 0);
  recorder.answered(seconds(2), answer);
  recorder.closed(seconds(3), false);
  REQUIRE(study.store->sessions().at(0).state == SessionState::stopped);
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("a session refuses what belongs to others") {
  StoredFixture study(1);
  const auto sink = study.store->begin_session(2, wrapped_key_of(2));
  SessionRecorder stranger(3, participant_key(3), *sink);
  REQUIRE(contains(refusal_of([&] { stranger.opened(nanoseconds(0), opening(3), "{}"); }),
                   "belongs to another chain"));
  SessionRecorder recorder(2, participant_key(2), *sink);
  SessionOpening taken = opening(2);
  taken.participant = "P1";
  REQUIRE(contains(refusal_of([&] { recorder.opened(nanoseconds(0), taken, "{}"); }),
                   "participant P1 already has session 1"));
  study.store->close_study(kUtc);
  REQUIRE(contains(refusal_of([&] { recorder.opened(nanoseconds(0), opening(2), "{}"); }),
                   "the study is closed"));
}

TEST_CASE("of two sessions that begin with one number the second is refused") {
  StoredFixture study;
  const auto first = study.store->begin_session(1, wrapped_key_of(1));
  const auto second = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder a(1, participant_key(1), *first);
  SessionRecorder b(1, participant_key(1), *second);
  a.opened(nanoseconds(0), opening(1), "{}");
  SessionOpening other = opening(2);
  REQUIRE(contains(refusal_of([&] { b.opened(nanoseconds(0), other, "{}"); }),
                   "session 1 is not the next one (2)"));
}

TEST_CASE("a sink takes a trace with its event and with no other") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  const BufferedEvents session = session_of(1);
  sink->accept(session.events[0], std::nullopt);
  REQUIRE(contains(refusal_of([&] { sink->accept(session.events[1], session.traces[0]); }),
                   "an event of this kind has no trace"));
  for (std::size_t i = 1; i < 5; ++i) sink->accept(session.events[i], std::nullopt);
  REQUIRE(session.events[5].kind == EventKind::trace_stored);
  REQUIRE(contains(refusal_of([&] { sink->accept(session.events[5], std::nullopt); }),
                   "the trace of trial 1 is missing"));
  REQUIRE(contains(refusal_of([&] { sink->accept(session.events[5], session.traces[1]); }),
                   "the trace of trial 1 is missing"));
  sink->accept(session.events[5], session.traces[0]);
  REQUIRE(study.store->sealed_trace(1, 1) == session.traces[0]);
}

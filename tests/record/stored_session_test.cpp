#include "core/files.hpp"
#include "record/sealing.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

UtcClock clock_at(nanoseconds utc) {
  return [utc] { return utc; };
}

/// A session that breaks off in its second trial.
void break_off(StudyStore& store) {
  const auto sink = store.begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  recorder.presented(seconds(1), 1, 0);
  recorder.answered(seconds(2), {.trial = 1, .answer = ChoiceAnswer{3}, .confidence = {}});
  recorder.presented(seconds(3), 2, 0);
}

void reopen(StoredFixture& study) {
  study.store.reset();
  study.store = writable(study.path);
}

SessionRecorder recorder_after_last(const StudyStore& store, EventSink& sink) {
  SessionRecorder recorder(1, participant_key(1), sink);
  recorder.continue_after(opened(store.last_event(1).value()));
  return recorder;
}

TrialEvidence evidence_of(const SessionRecorder& recorder, int trial) {
  TraceBody body{.trial = trial, .rate_hz = 1000.0};
  return recorder.pack_evidence(body, {}, stroking(20, 0.05));
}

AnswerBody answer_to(int trial) {
  return {.trial = trial, .answer = ChoiceAnswer{2}, .confidence = {}};
}

}  // namespace

TEST_CASE("a session stored event by event equals one stored whole") {
  StoredFixture whole(1);
  StoredFixture live;
  const auto sink = live.store->begin_session(1, wrapped_key_of(1), clock_at(kUtc));
  SessionRecorder recorder(1, participant_key(1), *sink);
  record_trials(recorder, 1, 3, stroking(20, 0.05), opening(1));

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

TEST_CASE("a station keeps the key of a session while it is open, and no longer") {
  StoredFixture study;
  const SecretKey station = digest_of("station");
  const Bytes kept = seal_station_copy(station, 1, participant_key(1));
  const auto sink = study.store->begin_session(1, wrapped_key_of(1), clock_at(kUtc), kept);
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  REQUIRE(study.store->kept_key(1) == kept);
  REQUIRE(open_station_copy(station, 1, kept) == participant_key(1));
  REQUIRE_FALSE(open_station_copy(station, 2, kept));
  REQUIRE_FALSE(open_station_copy(digest_of("another station"), 1, kept));
  REQUIRE_FALSE(study.store->first_fault());
  recorder.closed(seconds(1), false);
  REQUIRE_FALSE(study.store->kept_key(1));
  REQUIRE_FALSE(study.store->first_fault());
  for (const auto& file : std::filesystem::directory_iterator(study.path.parent_path())) {
    const std::string content = text_of(read_file(file.path()));
    REQUIRE_FALSE(contains(content, text_of(ByteView(kept).subspan(24))));
  }
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
  recorder.answered(seconds(2), {.trial = 1, .answer = ChoiceAnswer{3}, .confidence = {}});
  REQUIRE(reader.trials().at(0).state == TrialState::answered);
  REQUIRE(position_of(opened_trials(reader, 1).at(0).answer) == 3);
  REQUIRE_FALSE(reader.first_fault());
}

TEST_CASE("a refused event leaves no trace, and the session continues") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  REQUIRE(refuses([&] { recorder.presented(seconds(1), 1, 0); }));
  REQUIRE(study.store->events(0).size() == 1);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  const AnswerBody answer{.trial = 1, .answer = ChoiceAnswer{3}, .confidence = {}};
  REQUIRE(refuses([&] { recorder.answered(seconds(2), answer); }));
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
  REQUIRE(refuses([&] { stranger.opened(nanoseconds(0), opening(3), "{}"); }));
  SessionRecorder recorder(2, participant_key(2), *sink);
  SessionOpening taken = opening(2);
  taken.participant = "P1";
  REQUIRE(refuses([&] { recorder.opened(nanoseconds(0), taken, "{}"); }, "1"));
  study.store->close_study(kUtc);
  REQUIRE(refuses([&] { recorder.opened(nanoseconds(0), opening(2), "{}"); }));
}

TEST_CASE("of two sessions that begin with one number the second is refused") {
  StoredFixture study;
  const auto first = study.store->begin_session(1, wrapped_key_of(1));
  const auto second = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder a(1, participant_key(1), *first);
  SessionRecorder b(1, participant_key(1), *second);
  a.opened(nanoseconds(0), opening(1), "{}");
  SessionOpening other = opening(2);
  REQUIRE(refuses([&] { b.opened(nanoseconds(0), other, "{}"); }, "2"));
}

TEST_CASE("a sink takes a trace with its event and with no other") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  const BufferedEvents session = session_of(1);
  sink->accept(session.events[0], std::nullopt);
  REQUIRE(refuses([&] { sink->accept(session.events[1], session.traces[0]); }));
  for (std::size_t i = 1; i < 5; ++i) sink->accept(session.events[i], std::nullopt);
  REQUIRE(session.events[5].kind == EventKind::trace_stored);
  REQUIRE(refuses([&] { sink->accept(session.events[5], std::nullopt); }, "1"));
  REQUIRE(refuses([&] { sink->accept(session.events[5], session.traces[1]); }, "1"));
  sink->accept(session.events[5], session.traces[0]);
  REQUIRE(study.store->sealed_trace(1, 1) == session.traces[0]);
}

TEST_CASE("an interrupted session continues where it ended, in one chain") {
  StoredFixture study;
  break_off(*study.store);
  reopen(study);
  REQUIRE(study.store->sessions().at(0).state == SessionState::open);
  REQUIRE(study.store->next_session() == 2);
  REQUIRE_FALSE(study.store->first_fault());
  const auto sink = study.store->continue_session(1);
  SessionRecorder recorder = recorder_after_last(*study.store, *sink);
  REQUIRE(recorder.length() == 4);
  recorder.add(seconds(9), EventKind::resumed,
               ResumedBody{.after = "program-ended", .away_s = 6.0, .program_version = "1"});
  recorder.interrupted(seconds(9), 2, "program ended");
  recorder.presented(seconds(10), 2, 0);
  recorder.answered(seconds(12), answer_to(2), evidence_of(recorder, 2));
  recorder.closed(seconds(13), true);

  REQUIRE(study.store->sessions().at(0).state == SessionState::completed);
  REQUIRE(position_of(opened_trials(*study.store, 1).at(0).answer) == 3);
  REQUIRE(position_of(opened_trials(*study.store, 1).at(1).answer) == 2);
  REQUIRE(study.store->events(0).size() == 3);
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("a continued session refuses events that were recorded before") {
  StoredFixture study;
  break_off(*study.store);
  const auto sink = study.store->continue_session(1);
  SessionRecorder recorder = recorder_after_last(*study.store, *sink);
  REQUIRE(refuses([&] { recorder.answered(seconds(4), answer_to(1)); }, "1"));
  REQUIRE(refuses([&] { recorder.presented(seconds(2), 2, 0); }));
  SessionRecorder from_the_start(1, participant_key(1), *sink);
  REQUIRE(refuses(
      [&] { from_the_start.add(seconds(9), EventKind::noted, RemarkBody{.text = "again"}); }));
}

TEST_CASE("only a stored, open session of an open study can be continued") {
  StoredFixture study(1);
  REQUIRE(refuses([&] { (void)study.store->continue_session(1); }, "P1"));
  REQUIRE(refuses([&] { (void)study.store->continue_session(2); }, "2"));
  REQUIRE(refuses([&] { (void)study.store->continue_session(0); }, "0"));
  StoredFixture closed;
  break_off(*closed.store);
  closed.store->close_study(kUtc);
  REQUIRE(refuses([&] { (void)closed.store->continue_session(1); }));
}

TEST_CASE("of two programs that continue one session the slower is refused, and nothing is lost") {
  StoredFixture study;
  break_off(*study.store);
  StudyStore other = writable(study.path);
  const auto first = study.store->continue_session(1);
  const auto second = other.continue_session(1);
  SessionRecorder a = recorder_after_last(*study.store, *first);
  SessionRecorder b = recorder_after_last(other, *second);
  b.answered(seconds(5), answer_to(2));
  REQUIRE(refuses([&] { a.answered(seconds(6), answer_to(2)); }));
  REQUIRE(opened_trials(*study.store, 1).at(1).answered_at == seconds(5));
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("events that belong together are stored all or none") {
  StoredFixture study;
  const auto sink = study.store->begin_session(1, wrapped_key_of(1));
  SessionRecorder recorder(1, participant_key(1), *sink);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  recorder.presented(seconds(1), 1, 0);
  recorder.interrupted(seconds(2), 1, "device lost");
  // The trace could be stored, but the answer of an interrupted trial cannot.
  REQUIRE(names_in_order(
      refusal_of([&] { recorder.answered(seconds(3), answer_to(1), evidence_of(recorder, 1)); }),
      "1"));
  REQUIRE(study.store->events(1).size() == 3);
  REQUIRE_FALSE(study.store->sealed_trace(1, 1));
  REQUIRE_FALSE(study.store->trials().at(0).has_trace());
  recorder.presented(seconds(4), 1, 0);
  recorder.answered(seconds(5), answer_to(1), evidence_of(recorder, 1));
  REQUIRE(study.store->events(1).size() == 6);
  REQUIRE(study.store->sealed_trace(1, 1));
  const std::vector<Event> events = opened_events(*study.store, 1);
  REQUIRE(events.at(4).at == events.at(5).at);
  REQUIRE_FALSE(study.store->first_fault());
}

TEST_CASE("a participant's session and the smallest free enrolment are found") {
  StoredFixture study;
  REQUIRE(study.store->next_enrolment() == 1);
  add(*study.store, 1);
  SessionOpening third = opening(2);
  third.enrolment = 3;
  study.store->add_session(session_of(2, 3, stroking(20, 0.05), third), wrapped_key_of(2), kUtc);
  REQUIRE(study.store->next_enrolment() == 2);
  REQUIRE(study.store->session_of("P2").value().session == 2);
  REQUIRE(study.store->session_of("P2").value().state == SessionState::completed);
  REQUIRE_FALSE(study.store->session_of("P9"));
  const auto sink = study.store->begin_session(3, wrapped_key_of(3));
  SessionRecorder recorder(3, participant_key(3), *sink);
  SessionOpening second = opening(3);
  second.enrolment = 2;
  recorder.opened(nanoseconds(0), second, "{}");
  REQUIRE(study.store->session_of("P3").value().session == 3);
  REQUIRE(study.store->session_of("P3").value().state == SessionState::open);
  REQUIRE(study.store->last_event(3).value().kind == EventKind::opened);
  REQUIRE(study.store->next_enrolment() == 4);
}

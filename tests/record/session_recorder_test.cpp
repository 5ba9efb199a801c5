#include "record/session_recorder.hpp"

#include "core/errors.hpp"
#include "record/event.hpp"
#include "record/payload_json.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <set>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

/// Refuses everything until told otherwise.
class StubbornSink final : public EventSink {
 public:
  void accept(const Event& event, const std::optional<SealedTrace>& /*trace*/) override {
    if (refuses) throw StoreError("disk full");
    events.push_back(event);
  }
  bool refuses = true;
  std::vector<Event> events;
};

}  // namespace

TEST_CASE("a recorder makes a chain that holds") {
  const BufferedEvents session = session_of(4);
  ChainLink chain(4);
  for (const Event& event : session.events) {
    REQUIRE_FALSE(chain.link_fault(event));
    chain.extend(event);
  }
  REQUIRE(session.events.front().kind == EventKind::opened);
  REQUIRE(session.events.back().kind == EventKind::closed);
  REQUIRE(session.traces.size() == 3);
}

TEST_CASE("a recorder reports its head and length") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  REQUIRE(recorder.head() == Digest{});
  REQUIRE(recorder.length() == 0);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  recorder.presented(seconds(1), 1, 0);
  REQUIRE(recorder.head() == events.events.back().hash);
  REQUIRE(recorder.length() == 2);
}

TEST_CASE("schedule, measures and the end are secret, and only the right key opens events") {
  const BufferedEvents session = session_of(4);
  for (const Event& event : session.events) {
    const bool secret = event.kind == EventKind::opened || event.kind == EventKind::trace_stored ||
                        event.kind == EventKind::closed;
    REQUIRE(event.at.count() == 0);
    REQUIRE(unsealed(event, participant_key(4)).value().empty() != secret);
    REQUIRE_FALSE(unsealed(event, participant_key(5)));
    REQUIRE_FALSE(opened_event(event, participant_key(5)));
  }
  REQUIRE(unsealed(session.events.front(), participant_key(4)) == R"({"schedule":"4"})");
  const Event& end = session.events.back();
  REQUIRE(from_json<ChainEnd>(*unsealed(end, participant_key(4))) ==
          ChainEnd{.length = end.sequence, .head = end.previous});
  REQUIRE(measures_from_json(*unsealed(session.events[5], participant_key(4))) ==
          TrialMeasures{
              .contact_s = 0.1, .path_mm = 512.5, .force_rms_n = 0.05, .saturated_share = 0.0});
}

TEST_CASE("an opened event has the time and the body with which it was recorded") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  const auto recorded = [&](const std::string& body, const std::string& in_clear) {
    const Event& stored = events.events.back();
    REQUIRE(stored.body == in_clear);
    const OpenedEvent opened = opened_event(stored, participant_key(1)).value();
    REQUIRE(opened.event.body == body);
    REQUIRE(opened.event.at == nanoseconds(1'234'567'891));
    REQUIRE(opened.event.hash == stored.hash);
    REQUIRE(opened.event.sequence == stored.sequence);
  };
  const nanoseconds at(1'234'567'891);
  recorder.add(
      at, EventKind::practised,
      PracticeBody{.round = 2, .presentation = 3, .answer = ChoiceAnswer{1}, .correct = true});
  recorded(R"({"correct":true,"position":1,"presentation":3,"round":2})",
           R"({"presentation":3,"round":2})");
  recorder.presented(at, 7, 2);
  recorded(R"({"block":2,"trial":7})", R"({"block":2,"trial":7})");
  recorder.answered(at, {.trial = 7, .answer = ChoiceAnswer{4, 0}, .confidence = 5});
  recorded(R"({"confidence":5,"first_position":0,"position":4,"trial":7})", R"({"trial":7})");
  recorder.add(at, EventKind::noted, RemarkBody{.text = "sneezed"});
  recorded(R"({"text":"sneezed"})", "{}");
  recorder.add(at, EventKind::deviated, DeviationBody{"late", "ten minutes"});
  recorded(R"({"code":"late","text":"ten minutes"})", R"({"code":"late"})");
  recorder.add(at, EventKind::resumed,
               ResumedBody{.after = "pause", .away_s = 12.5, .program_version = "1"});
  recorded(R"({"after":"pause","away_s":12.5,"program_version":"1"})",
           R"({"after":"pause","program_version":"1"})");
  TraceBody body{.trial = 7, .samples = 0, .rate_hz = 1e3, .overruns = 2, .valid = true};
  body.hand.path = false;
  body.saturated = true;
  body.explorations = {900, 101};
  const TrialEvidence evidence = recorder.pack_evidence(body, {}, stroking(1001, 0.05));
  recorder.answered(at, {.trial = 7, .answer = ChoiceAnswer{4}, .confidence = {}}, evidence);
  const Event& stored = events.events[events.events.size() - 2];
  const std::string in_clear =
      R"({"contact_ok":true,"force_ok":true,"overruns":2,"path_ok":false,"rate_hz":1000.0,)"
      R"("speed_ok":true,"trace":")" +
      to_hex(evidence.body.trace) + R"(","trial":7,"valid":true})";
  REQUIRE(stored.body == in_clear);
  const TraceBody whole = from_json<TraceBody>(opened(stored).body);
  REQUIRE(whole.samples == 1001);
  REQUIRE(whole.saturated);
  REQUIRE(whole.explorations == std::vector<std::int64_t>{900, 101});
}

TEST_CASE("the size of a sealed part follows from the kind of its event") {
  const auto size_of = [](const AnswerBody& answer, nanoseconds at) {
    BufferedEvents events;
    SessionRecorder recorder(1, participant_key(1), events);
    recorder.answered(at, answer);
    return events.events.back().sealed.size();
  };
  const std::size_t least =
      size_of({.trial = 1, .answer = ChoiceAnswer{0}, .confidence = {}}, nanoseconds(0));
  REQUIRE(size_of({.trial = 99, .answer = ChoiceAnswer{63, 62}, .confidence = 100},
                  std::chrono::hours(9)) == least);
}

TEST_CASE("the size of an interruption does not depend on a flight record of up to three seconds") {
  const auto sealed_size = [](const std::string& row, std::int64_t ticks) {
    BufferedEvents events;
    SessionRecorder recorder(1, participant_key(1), events);
    InterruptionDetail detail{"overspeed", "none", ticks, ""};
    for (std::int64_t i = 0; i < ticks; ++i) detail.flight += row;
    recorder.interrupted(seconds(1), 3, "device fault", detail);
    REQUIRE(from_json<InterruptionDetail>(*unsealed(events.events.back(), participant_key(1))) ==
            detail);
    const auto clear = from_json<InterruptedBody>(events.events.back().body);
    REQUIRE(clear.reason == "device fault");
    REQUIRE(clear.safety_fault == "overspeed");
    REQUIRE(clear.device_fault == "none");
    return events.events.back().sealed.size();
  };
  const std::string smooth(90, '0');
  const std::string rough(330, '7');
  REQUIRE(sealed_size(smooth, 3001) == sealed_size(rough, 3001));
  REQUIRE(sealed_size(smooth, 10) == sealed_size(rough, 10));
  REQUIRE(sealed_size(smooth, 10) < sealed_size(smooth, 3001));
  REQUIRE(sealed_size(smooth, 0) == sealed_size(rough, 3000));
}

TEST_CASE("an interruption without a detail has no secret part") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  recorder.interrupted(seconds(1), 3, "comfort stop");
  REQUIRE(unsealed(events.events.back(), participant_key(1)).value().empty());
}

TEST_CASE("a sealed part cannot be moved to another event") {
  const BufferedEvents session = session_of(4);
  Event moved = session.events.front();
  moved.sequence = 1;
  REQUIRE_FALSE(unsealed(moved, participant_key(4)));
  moved = session.events.front();
  moved.kind = EventKind::noted;
  REQUIRE_FALSE(unsealed(moved, participant_key(4)));
  moved = session.events.front();
  moved.session = 5;
  REQUIRE_FALSE(unsealed(moved, participant_key(4)));
  moved = session.events[2];
  REQUIRE(opened_event(moved, participant_key(4)));
  moved.previous = session.events[3].previous;
  REQUIRE_FALSE(opened_event(moved, participant_key(4)));
  moved = session.events[2];
  moved.body = R"({"block":0,"trial":2})";
  REQUIRE_FALSE(opened_event(moved, participant_key(4)));
}

TEST_CASE("a stored trace opens with its session, trial and key alone") {
  const BufferedEvents session = session_of(4);
  const SealedTrace& sealed = session.traces[1];
  REQUIRE(sealed.session == 4);
  REQUIRE(sealed.trial == 2);
  const auto opened = unsealed_trace(sealed, participant_key(4));
  REQUIRE(opened.has_value());
  REQUIRE(encode_trace(*opened) == encode_trace(stroking(20, 0.05)));
  REQUIRE_FALSE(unsealed_trace({4, 1, sealed.box}, participant_key(4)));
  REQUIRE_FALSE(unsealed_trace({3, 2, sealed.box}, participant_key(4)));
  REQUIRE_FALSE(unsealed_trace({4, 2, sealed.box}, participant_key(3)));
  REQUIRE_FALSE(unsealed_trace({4, 2, Bytes{}}, participant_key(4)));
}

TEST_CASE("sealed measures are of one size whatever their values") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  std::set<std::size_t> sizes;
  for (const double x : {0.0, 1.0 / 3.0, -1.2345678901234567e-300}) {
    recorder.trace_stored(
        nanoseconds(0),
        {.trial = 1, .samples = 0, .rate_hz = 1e3, .overruns = 0, .valid = true, .trace = {}},
        {.contact_s = x, .path_mm = x, .force_rms_n = x, .saturated_share = x}, stroking(5, 0.0));
    sizes.insert(events.events.back().sealed.size());
  }
  REQUIRE(sizes.size() == 1);
}

TEST_CASE("equal trials of two sessions have nothing in common in their sealed parts") {
  const BufferedEvents a = session_of(1);
  const BufferedEvents b = session_of(2);
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    REQUIRE(a.events[i].sealed != b.events[i].sealed);
  }
  REQUIRE(a.traces[0].box != a.traces[1].box);
  REQUIRE(a.traces[0].box != b.traces[0].box);
}

TEST_CASE("time must not run backwards in a session") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  REQUIRE_THROWS_AS(recorder.opened(nanoseconds(-1), opening(1), "{}"), StoreError);
  recorder.opened(seconds(2), opening(1), "{}");
  REQUIRE_THROWS_AS(recorder.presented(seconds(1), 1, 0), StoreError);
  recorder.presented(seconds(2), 1, 0);
  REQUIRE(recorder.length() == 2);
}

TEST_CASE("an event that the sink refuses is not part of the chain") {
  StubbornSink sink;
  SessionRecorder recorder(1, participant_key(1), sink);
  REQUIRE_THROWS_AS(recorder.opened(seconds(2), opening(1), "{}"), StoreError);
  REQUIRE(recorder.length() == 0);
  REQUIRE(recorder.head() == Digest{});
  sink.refuses = false;
  recorder.opened(seconds(1), opening(1), "{}");
  REQUIRE(sink.events.front().sequence == 0);
  REQUIRE(sink.events.front().previous == Digest{});
}

TEST_CASE("events are recorded with the body of their kind alone") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  recorder.opened(seconds(1), opening(1), "{}");
  for (const EventKind kind :
       {EventKind::calibrated, EventKind::instructed, EventKind::ticked, EventKind::break_taken}) {
    recorder.add(seconds(1), kind, TextBody{.text = "text"});
    REQUIRE(events.events.back().kind == kind);
    REQUIRE(opened(events.events.back()).body == R"({"text":"text"})");
  }
  REQUIRE_THROWS_AS(recorder.add(seconds(1), EventKind::answered, TextBody{.text = ""}),
                    StoreError);
  REQUIRE_THROWS_AS(recorder.add(seconds(1), EventKind::practised, TextBody{.text = ""}),
                    StoreError);
  REQUIRE_THROWS_AS(recorder.add(seconds(1), EventKind::study_closed, TextBody{.text = ""}),
                    StoreError);
}

TEST_CASE("a wrapped participant key opens with its study and session alone") {
  const Bytes wrapped = wrapped_key_of(3).participant;
  REQUIRE(unwrap_participant_key(box_keys(study_master()), 3, wrapped) == participant_key(3));
  REQUIRE_FALSE(unwrap_participant_key(box_keys(study_master()), 4, wrapped));
  REQUIRE_FALSE(unwrap_participant_key(box_keys(digest_of("other")), 3, wrapped));
  REQUIRE_FALSE(unwrap_participant_key(box_keys(study_master()), 3, Bytes{}));
  Bytes altered = wrapped;
  altered.back() ^= 1U;
  REQUIRE_FALSE(unwrap_participant_key(box_keys(study_master()), 3, altered));
}

TEST_CASE("the safety key opens only reasons of stops and deviations") {
  BufferedEvents session = session_of(3);
  SessionRecorder recorder(3, participant_key(3), session);
  recorder.continue_after(session.events.back());
  recorder.add(seconds(200), EventKind::deviated,
               DeviationBody{.code = "no-curtain", .text = "in the wash"});
  recorder.add(seconds(201), EventKind::stopped, StopBody{.code = "", .text = "a cramp"});
  recorder.add(seconds(202), EventKind::noted, RemarkBody{.text = "tall"});
  recorder.add(seconds(203), EventKind::paused, PauseBody{.text = "called his wife"});
  const SecretKey safety = safety_key(participant_key(3));
  std::vector<std::string> bodies;
  for (const Event& event : session.events) {
    if (const auto opened = opened_safety_event(event, safety))
      bodies.push_back(opened->event.body);
    REQUIRE_FALSE(opened_event(event, safety));  // it is not taken for the participant's key
    REQUIRE(opened_event(event, participant_key(3)));
  }
  // The end of a session, whose largest force is sealed for safety, comes first.
  REQUIRE(bodies == std::vector<std::string>{R"({"complete":true})",
                                             R"({"code":"no-curtain","text":"in the wash"})",
                                             R"({"text":"a cramp"})"});
  for (const Event& event : session.events) {
    for (const char* const words : {"wash", "cramp", "tall", "wife"}) {
      REQUIRE_FALSE(contains(event.body, words));
    }
  }
}

TEST_CASE("a wrapped safety key opens with its study and session alone, and is not the other key") {
  const NewKeys keys = wrapped_key_of(3);
  const BoxKeys investigator = box_keys(study_master());
  REQUIRE(unwrap_safety_key(investigator, 3, keys.safety) == safety_key(participant_key(3)));
  REQUIRE_FALSE(unwrap_safety_key(investigator, 4, keys.safety));
  REQUIRE_FALSE(unwrap_safety_key(box_keys(digest_of("other")), 3, keys.safety));
  REQUIRE_FALSE(unwrap_participant_key(investigator, 3, keys.safety));
  REQUIRE_FALSE(unwrap_safety_key(investigator, 3, keys.participant));
}

TEST_CASE("the largest force of a trace and of a session are sealed") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  Trace trace = stroking(50, 0.0);
  trace.samples[20].force_n = {3.0, 0.0, -4.0};
  TraceBody body{.trial = 1};
  recorder.trace_stored(seconds(1), body, {}, trace);
  const Event stored = events.events.back();
  REQUIRE_FALSE(contains(stored.body, "largest_force"));
  REQUIRE(from_json<TraceBody>(opened(stored).body).largest_force_n == 5.0);
  recorder.closed(seconds(2), true, 1, false, 3.149);
  const Event end = events.events.back();
  REQUIRE(end.body == R"({"answers":1,"complete":true})");
  REQUIRE(from_json<ClosedBody>(opened(end).body).largest_force_n == 3.1);
  const auto left = opened_safety_event(end, safety_key(participant_key(1)));
  REQUIRE(from_json<ClosedBody>(left.value().event.body).largest_force_n == 3.1);
}

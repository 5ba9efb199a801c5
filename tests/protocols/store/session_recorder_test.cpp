#include "protocols/store/session_recorder.hpp"

#include "core/errors.hpp"
#include "protocols/store/event.hpp"
#include "protocols/store/payload_json.hpp"
#include "protocols/store/store_fixture.hpp"
#include "support/catch.hpp"

#include <set>

using namespace touchtrial;
using namespace touchtrial::store;
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
    REQUIRE_FALSE(chain.broken_by(event));
    chain.extend(event);
  }
  REQUIRE(session.events.front().kind == EventKind::opened);
  REQUIRE(session.events.back().kind == EventKind::closed);
  REQUIRE(session.traces.size() == 3);
}

TEST_CASE("a recorder knows its head and length") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  REQUIRE(recorder.head() == Digest{});
  REQUIRE(recorder.length() == 0);
  recorder.opened(nanoseconds(0), opening(1), "{}");
  recorder.presented(seconds(1), 1, 0);
  REQUIRE(recorder.head() == events.events.back().hash);
  REQUIRE(recorder.length() == 2);
}

TEST_CASE("only schedule, measures and the end are sealed, and only the right key opens them") {
  const BufferedEvents session = session_of(4);
  for (const Event& event : session.events) {
    const bool secret = event.kind == EventKind::opened || event.kind == EventKind::trace_stored ||
                        event.kind == EventKind::closed;
    REQUIRE(event.sealed.empty() != secret);
    REQUIRE(unsealed(event, participant_key(4)).has_value() == secret);
    REQUIRE_FALSE(unsealed(event, participant_key(5)));
  }
  REQUIRE(unsealed(session.events.front(), participant_key(4)) == R"({"schedule":"4"})");
  const Event& end = session.events.back();
  REQUIRE(chain_end_from_json(*unsealed(end, participant_key(4))) ==
          ChainEnd{.length = end.sequence, .head = end.previous});
  REQUIRE(measures_from_json(*unsealed(session.events[5], participant_key(4))) ==
          TrialMeasures{
              .contact_s = 0.1, .path_mm = 512.5, .force_rms_n = 0.05, .saturated_share = 0.0});
}

TEST_CASE("the size of an interruption depends on its flight record's number of ticks alone") {
  const auto sealed_size = [](const std::string& row, std::int64_t ticks) {
    BufferedEvents events;
    SessionRecorder recorder(1, participant_key(1), events);
    InterruptionDetail detail{"overspeed", "none", ticks, ""};
    for (std::int64_t i = 0; i < ticks; ++i) detail.flight += row;
    recorder.interrupted(seconds(1), 3, "device fault", detail);
    REQUIRE(interruption_from_json(*unsealed(events.events.back(), participant_key(1))) == detail);
    REQUIRE(trial_from_json(events.events.back().body).reason == "device fault");
    return events.events.back().sealed.size();
  };
  const std::string smooth(90, '0');
  const std::string rough(330, '7');
  REQUIRE(sealed_size(smooth, 3001) == sealed_size(rough, 3001));
  REQUIRE(sealed_size(smooth, 10) == sealed_size(rough, 10));
  REQUIRE(sealed_size(smooth, 10) < sealed_size(smooth, 3001));
}

TEST_CASE("an interruption without a detail has no sealed part") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  recorder.interrupted(seconds(1), 3, "comfort stop");
  REQUIRE(events.events.back().sealed.empty());
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
}

TEST_CASE("a stored trace opens with its session, trial, key and number of samples alone") {
  const BufferedEvents session = session_of(4);
  const SealedTrace& sealed = session.traces[1];
  REQUIRE(sealed.session == 4);
  REQUIRE(sealed.trial == 2);
  const auto opened = unsealed_trace(sealed, participant_key(4), 20);
  REQUIRE(opened.has_value());
  REQUIRE(encode_trace(*opened) == encode_trace(stroking(20, 0.05)));
  REQUIRE_FALSE(unsealed_trace({4, 1, sealed.box}, participant_key(4), 20));
  REQUIRE_FALSE(unsealed_trace({3, 2, sealed.box}, participant_key(4), 20));
  REQUIRE_FALSE(unsealed_trace({4, 2, sealed.box}, participant_key(3), 20));
  REQUIRE_FALSE(unsealed_trace({4, 2, sealed.box}, participant_key(4), 21));
  REQUIRE_FALSE(unsealed_trace({4, 2, Bytes{}}, participant_key(4), 20));
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
    if (!a.events[i].sealed.empty()) REQUIRE(a.events[i].sealed != b.events[i].sealed);
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

TEST_CASE("only remarks are recorded as remarks") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  recorder.opened(seconds(1), opening(1), "{}");
  for (const EventKind kind :
       {EventKind::calibrated, EventKind::instructed, EventKind::ticked, EventKind::break_taken,
        EventKind::paused, EventKind::stopped, EventKind::noted}) {
    recorder.remarked(seconds(1), kind, "text");
    REQUIRE(events.events.back().kind == kind);
    REQUIRE(events.events.back().body == R"({"text":"text"})");
  }
  REQUIRE_THROWS_AS(recorder.remarked(seconds(1), EventKind::answered, ""), StoreError);
  REQUIRE_THROWS_AS(recorder.remarked(seconds(1), EventKind::practised, ""), StoreError);
  REQUIRE_THROWS_AS(recorder.remarked(seconds(1), EventKind::study_closed, ""), StoreError);
}

TEST_CASE("a wrapped participant key opens with its study and session alone") {
  const Bytes wrapped = wrapped_key_of(3);
  REQUIRE(unwrap_participant_key(box_keys(study_master()), 3, wrapped) == participant_key(3));
  REQUIRE_FALSE(unwrap_participant_key(box_keys(study_master()), 4, wrapped));
  REQUIRE_FALSE(unwrap_participant_key(box_keys(digest_of("other")), 3, wrapped));
  REQUIRE_FALSE(unwrap_participant_key(box_keys(study_master()), 3, Bytes{}));
  Bytes altered = wrapped;
  altered.back() ^= 1U;
  REQUIRE_FALSE(unwrap_participant_key(box_keys(study_master()), 3, altered));
}

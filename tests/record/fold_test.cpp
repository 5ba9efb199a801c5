#include "record/fold.hpp"

#include "core/errors.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

/// A session that folds as it is recorded, opened and as it is stored.
class FoldedSession final : public EventSink {
 public:
  FoldedSession() { recorder.opened(nanoseconds(0), opening(1), "{}"); }

  void accept(const Event& event, const std::optional<SealedTrace>& /*trace*/) override {
    DerivedRows next = rows;
    fold(next, opened(event));
    fold(in_clear, event);
    rows = next;
  }
  void answer(int trial) {
    recorder.answered(seconds(2), {.trial = trial, .answer = ChoiceAnswer{1}, .confidence = {}});
  }
  void trace(int trial) {
    recorder.trace_stored(
        seconds(2),
        {.trial = trial, .samples = 0, .rate_hz = 1e3, .overruns = 0, .valid = true, .trace = {}},
        {}, stroking(3, 0.0));
  }
  const TrialRow& row(int trial) { return rows.trials.at({1, trial}); }

  DerivedRows rows;
  DerivedRows in_clear;
  SessionRecorder recorder{1, participant_key(1), *this};
};

}  // namespace

TEST_CASE("a trial goes from presented by contact to answered") {
  FoldedSession session;
  session.recorder.presented(seconds(1), 1, 4);
  REQUIRE(session.row(1).state == TrialState::presented);
  REQUIRE(session.row(1).block == 4);
  REQUIRE_FALSE(session.row(1).contact_at);
  session.recorder.first_contact(seconds(1) + milliseconds(1), 1);
  session.recorder.first_contact(seconds(1) + milliseconds(2), 1);
  REQUIRE(session.row(1).contact_at == seconds(1) + milliseconds(1));
  session.answer(1);
  REQUIRE(session.row(1).state == TrialState::answered);
  REQUIRE(session.row(1).answered_at == seconds(2));
  REQUIRE(position_of(session.row(1).answer) == 1);
}

TEST_CASE("stored events give the rows that opened ones give, without answers and times") {
  FoldedSession session;
  session.recorder.presented(seconds(1), 1, 0);
  session.recorder.first_contact(seconds(1), 1);
  session.recorder.add(seconds(1), EventKind::explored_again, TrialBody{1});
  session.trace(1);
  session.recorder.answered(seconds(2),
                            {.trial = 1, .answer = ChoiceAnswer{1, 2}, .confidence = 3});
  TrialRow expected = session.row(1);
  REQUIRE(expected.samples == 3);
  expected.presented_at = {};
  expected.contact_at.reset();
  expected.answered_at.reset();
  expected.answer.reset();
  expected.confidence.reset();
  expected.samples = 0;
  REQUIRE(session.in_clear.trials.at({1, 1}) == expected);
  REQUIRE(expected.state == TrialState::answered);
  REQUIRE(expected.explorations == 2);
  REQUIRE(expected.has_trace());
  REQUIRE(session.in_clear.sessions == session.rows.sessions);
}

TEST_CASE("a trial may be answered after its time is up") {
  FoldedSession session;
  session.recorder.presented(seconds(1), 1, 0);
  session.recorder.timed_out(seconds(1), 1);
  REQUIRE(session.row(1).state == TrialState::timed_out);
  REQUIRE_FALSE(position_of(session.row(1).answer));
  session.answer(1);
  REQUIRE(session.row(1).state == TrialState::answered);
}

TEST_CASE("an interrupted trial restarts when it is presented again") {
  FoldedSession session;
  session.recorder.presented(seconds(1), 1, 0);
  session.recorder.first_contact(seconds(1), 1);
  session.recorder.interrupted(seconds(1), 1, "fire alarm");
  REQUIRE(session.row(1).state == TrialState::interrupted);
  REQUIRE_THROWS_AS(session.answer(1), StoreError);
  session.recorder.presented(seconds(2), 1, 0);
  REQUIRE(session.row(1).presented_at == seconds(2));
  REQUIRE_FALSE(session.row(1).contact_at);
  session.answer(1);
  REQUIRE(session.row(1).state == TrialState::answered);
}

TEST_CASE("an impossible event is refused with its place and leaves the rows as they were") {
  FoldedSession session;
  const auto refused = [&](auto&& work, const std::string& words = "") {
    const DerivedRows before = session.rows;
    const std::string line = refusal_of(work);
    REQUIRE(names_in_order(line, "1 " + words));
    REQUIRE(session.rows.trials == before.trials);
    REQUIRE(session.in_clear.sessions == before.sessions);
    REQUIRE(session.rows.sessions == before.sessions);
  };
  refused([&] { session.answer(1); }, "1");
  refused([&] { session.trace(1); }, "1");
  session.recorder.presented(seconds(1), 1, 0);
  session.answer(1);
  refused([&] { session.answer(1); }, "1");
  refused([&] { session.recorder.timed_out(seconds(2), 1); }, "1");
  refused([&] { session.recorder.presented(seconds(2), 1, 0); }, "1");
  session.recorder.presented(seconds(2), 2, 0);
  session.recorder.timed_out(seconds(2), 2);
  session.trace(2);
  refused([&] { session.recorder.presented(seconds(2), 2, 0); }, "2");
  refused([&] { session.recorder.opened(seconds(2), opening(1), "{}"); });
  session.recorder.closed(seconds(3), false);
  REQUIRE(session.rows.sessions.at(1).state == SessionState::stopped);
  refused([&] { session.recorder.add(seconds(3), EventKind::noted, RemarkBody{.text = ""}); });
}

TEST_CASE("a session that was never opened takes no events") {
  BufferedEvents events;
  SessionRecorder recorder(1, participant_key(1), events);
  recorder.presented(seconds(1), 1, 0);
  DerivedRows rows;
  REQUIRE(refuses([&] { fold(rows, events.events.front()); }));
}

TEST_CASE("exploring again is counted for each presentation") {
  FoldedSession session;
  session.recorder.presented(seconds(1), 1, 0);
  REQUIRE(session.row(1).explorations == 1);
  session.recorder.add(seconds(1), EventKind::explored_again, TrialBody{1});
  session.recorder.add(seconds(1), EventKind::explored_again, TrialBody{1});
  REQUIRE(session.row(1).explorations == 3);
  session.recorder.interrupted(seconds(1), 1, "device lost");
  REQUIRE_THROWS_AS(session.recorder.add(seconds(1), EventKind::explored_again, TrialBody{1}),
                    StoreError);
  session.recorder.presented(seconds(2), 1, 0);
  REQUIRE(session.row(1).explorations == 1);
  session.answer(1);
  REQUIRE_THROWS_AS(session.recorder.add(seconds(2), EventKind::explored_again, TrialBody{1}),
                    StoreError);
}

TEST_CASE("restarting a block voids its presented trials and nothing else") {
  FoldedSession session;
  session.recorder.presented(seconds(1), 1, 0);
  session.answer(1);
  session.recorder.presented(seconds(2), 3, 1);
  session.answer(3);
  session.recorder.presented(seconds(2), 4, 1);
  session.recorder.interrupted(seconds(2), 4, "device lost");
  session.recorder.block_restarted(seconds(3), 1, 7, "[]");
  REQUIRE(session.row(1).state == TrialState::answered);
  REQUIRE(session.row(3).state == TrialState::voided);
  REQUIRE(position_of(session.row(3).answer) == 1);
  REQUIRE(session.row(4).state == TrialState::voided);
  session.recorder.presented(seconds(4), 7, 1);
  REQUIRE(session.row(7).state == TrialState::presented);
  session.recorder.block_restarted(seconds(5), 1, 9, "[]");
  REQUIRE(session.row(7).state == TrialState::voided);
}

TEST_CASE("a voided trial takes no more events, and a block's new numbers are new") {
  FoldedSession session;
  session.recorder.presented(seconds(1), 2, 0);
  session.recorder.interrupted(seconds(1), 2, "device lost");
  const auto restart = [&](int first) {
    session.recorder.block_restarted(seconds(2), 0, first, "[]");
  };
  REQUIRE(refuses([&] { restart(2); }));
  REQUIRE(session.row(2).state == TrialState::interrupted);
  restart(3);
  const auto refused = [&](auto&& work) { return refuses(work, "2"); };
  REQUIRE(refused([&] { session.recorder.presented(seconds(3), 2, 0); }));
  REQUIRE(
      refused([&] { session.recorder.add(seconds(3), EventKind::explored_again, TrialBody{2}); }));
  REQUIRE(refused([&] { session.recorder.first_contact(seconds(3), 2); }));
  REQUIRE(refused([&] { session.answer(2); }));
  REQUIRE(refused([&] { session.trace(2); }));
}

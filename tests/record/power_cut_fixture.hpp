/// \file Operations on a database (stories), which faults interrupt, and what must be left
///   afterwards.
#pragma once

#include "record/noting_sink.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"
#include "support/fault_vfs.hpp"

#include <functional>
#include <string>
#include <vector>

namespace touchtrial::fixture {

using testing::DiskOperation;
using testing::Fault;
using testing::FaultVfs;

/// What the database acknowledged as safe.
struct Acknowledged {
  std::vector<record::Event> session;  ///< of session 2, event by event
  record::ChainHead file;     ///< end of the file's chain after the last change that returned
  std::size_t under_way = 2;  ///< the most events of session 2 that one step stores
};

/// Operations on an open database that has session 1.
using Story = std::function<void(record::StudyStore&, Acknowledged&)>;

/// Does one step of a session; may repeat it if it is refused.
using Attempt = std::function<void(const std::function<void()>&)>;

/// Trials of session 2: all after the first do the same operations.
inline constexpr int kTrials = 2;

/// Session 2, each answer stored together with its trace.
inline void record_session(record::StudyStore& store, Acknowledged& acknowledged,
                           const Attempt& attempt) {
  NotingSink sink(store.begin_session(2, wrapped_key_of(2), [] { return kUtc; }),
                  acknowledged.session);
  record::SessionRecorder recorder(2, participant_key(2), sink);
  const record::Trace trace = stroking(400, 0.05);
  attempt([&] { recorder.opened(nanoseconds(0), opening(2), R"({"schedule":"2"})"); });
  attempt([&] {
    recorder.add(seconds(1), record::EventKind::instructed, record::TextBody{.text = "read aloud"});
  });
  for (int trial = 1; trial <= kTrials; ++trial) {
    const nanoseconds start = seconds(20 * trial);
    attempt([&] { recorder.presented(start, trial, 0); });
    attempt([&] { recorder.first_contact(start + milliseconds(350), trial); });
    const record::TraceBody body{
        .trial = trial, .samples = 0, .rate_hz = 1000.0, .overruns = 0, .valid = true, .trace = {}};
    const record::TrialEvidence evidence = recorder.pack_evidence(body, {}, trace);
    const record::AnswerBody answer{
        .trial = trial, .answer = ChoiceAnswer{trial}, .confidence = {}};
    attempt([&] { recorder.answered(start + seconds(9), answer, evidence); });
  }
  attempt([&] { recorder.closed(seconds(90), true); });
}

/// The same, each step once.
inline void tell_session(record::StudyStore& store, Acknowledged& acknowledged) {
  record_session(store, acknowledged, [](const std::function<void()>& step) { step(); });
}

/// A study with one finished session, made once; to be copied.
inline const std::filesystem::path& finished_session() {
  static StoredFixture study(1);
  study.store.reset();
  return study.path;
}

/// The result of a story's run.
struct Outcome {
  Acknowledged acknowledged;
  std::string refusal;  ///< the message with which it ended early
};

/// Opens the database and runs the story until it ends or is broken off.
inline Outcome tell(const std::filesystem::path& path, const Story& story) {
  Outcome outcome;
  outcome.refusal = refusal_of([&] {
    record::StudyStore store = writable(path);
    story(store, outcome.acknowledged);
  });
  return outcome;
}

/// Requires that everything that was acknowledged is there, once, and that the chain is intact.
inline void require_kept(const record::StudyStore& store, const Acknowledged& acknowledged) {
  const auto fault = store.first_fault();
  INFO((fault ? fault->what : std::string()));
  REQUIRE_FALSE(fault);
  const std::vector<record::Event> kept = store.events(2);
  REQUIRE(kept.size() >= acknowledged.session.size());
  // At most one step was under way.
  REQUIRE(kept.size() <= acknowledged.session.size() + acknowledged.under_way);
  for (std::size_t i = 0; i < acknowledged.session.size(); ++i) {
    REQUIRE(kept[i].hash == acknowledged.session[i].hash);
  }
  const std::vector<record::Event> file = store.events(0);
  REQUIRE(file.size() >= static_cast<std::size_t>(acknowledged.file.length));
  if (acknowledged.file.length > 0) {
    REQUIRE(file[static_cast<std::size_t>(acknowledged.file.length) - 1].hash ==
            acknowledged.file.hash);
  }
}

/// Continues session 2 from where it broke off to its end.
inline void finish_session(record::StudyStore& store) {
  const auto row = store.session_of(participant_of(2));
  if (!row || row->state != record::SessionState::open || store.state().closed) return;
  const auto sink = store.continue_session(2, [] { return kUtc; });
  record::SessionRecorder recorder(2, participant_key(2), *sink);
  recorder.continue_after(store.last_event(2).value());
  recorder.add(seconds(100), record::EventKind::resumed,
               record::ResumedBody{.after = "program-ended", .away_s = 1.0, .program_version = ""});
  recorder.closed(seconds(101), false);
}

/// Requires that the database accepts what may follow: the rest of session 2, another session, and
/// changes of the file's chain.
inline void require_writable(const std::filesystem::path& path) {
  record::StudyStore store = writable(path);
  finish_session(store);
  if (!store.state().closed) add(store, store.next_session());
  if (!store.sessions().at(0).excluded) store.exclude(1, kUtc, "a test");
  if (!store.sessions().at(0).withdrawn) store.withdraw(1, kUtc, "a test");
  REQUIRE_FALSE(store.first_fault());
}

/// The number of disk operations of a story without faults.
inline std::int64_t operations_of(FaultVfs& vfs, const Story& story) {
  StoredFixture study(finished_session());
  vfs.plan({});
  REQUIRE(tell(study.path, story).refusal.empty());
  return vfs.operations();
}

}  // namespace touchtrial::fixture

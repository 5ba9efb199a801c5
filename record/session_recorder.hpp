/// \file Records one session as chained, sealed events.
#pragma once

#include "record/event_kinds.hpp"
#include "record/payload_json.hpp"
#include "record/sealing.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::record {

/// An event, and the trace of a trace_stored event.
struct RecordedEvent {
  Event event;
  std::optional<SealedTrace> trace;
};

/// The evidence of a presentation, ready to be stored with its answer.
struct TrialEvidence {
  TraceBody body;
  TrialMeasures measures;
  SealedTrace trace;
};

/// The destination of events. When `accept` returns, a durable sink has them on the disk.
class EventSink {
 public:
  virtual ~EventSink() = default;
  /// \param trace  only with a trace_stored event
  /// \throws StoreError if the event cannot be stored; it is then not part of the chain
  virtual void accept(const Event& event, const std::optional<SealedTrace>& trace) = 0;
  /// Accepts events that belong together. A durable sink stores all or none of them.
  virtual void accept_together(std::span<const RecordedEvent> events) {
    for (const auto& [event, trace] : events) accept(event, trace);
  }
};

/// Collects a session in memory, for StudyStore::add_session.
class BufferedEvents final : public EventSink {
 public:
  void accept(const Event& event, const std::optional<SealedTrace>& trace) override;

  std::vector<Event> events;
  std::vector<SealedTrace> traces;
};

/// The growing chain of one session. Not thread-safe. Times must not be negative or decrease. Every
/// function that records throws StoreError if the time decreases, a text is not UTF-8, or the sink
/// refuses; the chain is then unchanged.
class SessionRecorder {
 public:
  /// \param session  number in the database, from 1
  /// \param participant_key  encrypts this participant's payloads
  SessionRecorder(int session, const SecretKey& participant_key, EventSink& sink);

  /// \param secret_schedule  JSON of schedule and layout, sealed
  void opened(std::chrono::nanoseconds at, const SessionOpening& opening,
              const std::string& secret_schedule);
  void presented(std::chrono::nanoseconds at, int trial, int block);
  void first_contact(std::chrono::nanoseconds at, int trial);
  /// \param evidence  of the same presentation; stored atomically with the answer
  void answered(std::chrono::nanoseconds at, const AnswerBody& answer,
                const std::optional<TrialEvidence>& evidence = std::nullopt);
  /// \param reason  unencrypted: a fixed phrase, independent of the stimulus, never free text
  /// \param detail  sealed except the faults' names; the padding is the same for flight records of
  ///   up to 3,000 ticks, and depends on whole thousands of longer ones
  void interrupted(std::chrono::nanoseconds at, int trial, const std::string& reason,
                   const std::optional<InterruptionDetail>& detail = std::nullopt);
  void timed_out(std::chrono::nanoseconds at, int trial,
                 const std::optional<TrialEvidence>& evidence = std::nullopt);
  /// Encodes and seals a trace, and fills `body.trace`, `body.samples` and `body.largest_force_n`.
  /// Takes a few milliseconds for each second of exploration. May be called on another thread
  /// during recording.
  [[nodiscard]] TrialEvidence pack_evidence(TraceBody body, const TrialMeasures& measures,
                                            const Trace& trace) const;
  /// Stores the result of `pack_evidence`, without an answer.
  void trace_stored(std::chrono::nanoseconds at, const TraceBody& body,
                    const TrialMeasures& measures, const Trace& trace);
  /// \param first_trial  new number of the block's first trial
  /// \param secret_schedule  JSON of the block's new presentations, sealed
  void block_restarted(std::chrono::nanoseconds at, int block, int first_trial,
                       const std::string& secret_schedule);
  /// Records any other event: a body and perhaps a sealed text.
  /// \throws StoreError also if `Body` is not the body of this kind
  template <typename Body>
  void add(std::chrono::nanoseconds at, EventKind kind, const Body& body,
           const std::string& secret = {}) {
    add_described(at, kind, describe_body<Body>, to_json(body), secret);
  }
  /// Seals the chain's current length and head into the event, see ChainEnd.
  /// \param complete  whether the schedule was finished
  /// \param answers, one_key, largest_force_n  see ClosedBody
  void closed(std::chrono::nanoseconds at, bool complete, int answers = 0, bool one_key = false,
              std::optional<double> largest_force_n = std::nullopt);

  /// Continues a stored chain.
  /// \param last  its last event, opened
  void continue_after(const Event& last);

  /// Hash of the last event; zeros before the first.
  [[nodiscard]] const Digest& head() const noexcept { return head_; }
  [[nodiscard]] std::int64_t length() const noexcept { return length_; }

 private:
  struct Draft {
    EventKind kind{};
    std::string body;  ///< public and sealed members
    std::string secret{};
    std::optional<std::size_t> padding{};  ///< empty: the kind's
    std::optional<SealedTrace> trace{};
  };
  void add_described(std::chrono::nanoseconds at, EventKind kind, DescribeBody describe,
                     std::string body, std::string secret);
  void append(std::chrono::nanoseconds at, Draft draft);
  /// Appends all or none, in order, with the same time.
  void append_together(std::chrono::nanoseconds at, std::span<Draft> drafts);
  /// Appends after the presentation's trace, if there is one.
  void append_with_evidence(std::chrono::nanoseconds at,
                            const std::optional<TrialEvidence>& evidence, Draft draft);
  [[nodiscard]] RecordedEvent make_event(std::chrono::nanoseconds at, std::int64_t sequence,
                                         const Digest& previous, Draft& draft) const;
  [[nodiscard]] static Draft draft_of(TrialEvidence evidence);

  int session_;
  SecretKey participant_key_;
  EventSink& sink_;
  Digest head_{};
  std::int64_t length_ = 0;
  std::chrono::nanoseconds last_at_{0};
};

}  // namespace touchtrial::record

/// \file Turns what happens in one session into chained, sealed events.
#pragma once

#include "core/cipher.hpp"
#include "protocols/store/event.hpp"
#include "protocols/store/payload.hpp"
#include "protocols/store/trace.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial {

/// An encrypted trace on its way to the database.
struct SealedTrace {
  int session = 0;
  int trial = 0;
  Bytes box;
};

/// Where events go. A durable sink has them on disk when `accept` returns.
class EventSink {
 public:
  virtual ~EventSink() = default;
  /// `trace` accompanies a trace_stored event and no other.
  /// \throws StoreError if the event cannot be stored; it is then not part of the chain
  virtual void accept(const Event& event, const std::optional<SealedTrace>& trace) = 0;
};

/// Keeps a whole session in memory, for StudyStore::add_session.
class BufferedEvents final : public EventSink {
 public:
  void accept(const Event& event, const std::optional<SealedTrace>& trace) override;

  std::vector<Event> events;
  std::vector<SealedTrace> traces;
};

/// Events' sealed parts are padded to a multiple of this many bytes.
inline constexpr std::size_t kEventPadding = 256;

/// That of an interruption: a function of its flight record's ticks alone, so that the size does
/// not tell rough textures from smooth ones. A multiple of kEventPadding.
[[nodiscard]] std::size_t interruption_padding(std::int64_t ticks);

/// One session's chain, growing. Not thread-safe; any number may run beside each other.
/// Times must not be negative nor decrease. Every function that records throws StoreError if the
/// time does, if a text is not UTF-8, or if the sink refuses: the chain is then as it was.
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
  void answered(std::chrono::nanoseconds at, const AnswerBody& answer);
  /// \param reason  in clear: must tell nothing of the stimulus  \param detail  sealed, under
  ///   a padding that follows from the flight record's number of ticks
  void interrupted(std::chrono::nanoseconds at, int trial, const std::string& reason,
                   const std::optional<InterruptionDetail>& detail = std::nullopt);
  void timed_out(std::chrono::nanoseconds at, int trial);
  /// Encodes, seals and stores a trace; fills `body.trace` and `body.samples` itself.
  void trace_stored(std::chrono::nanoseconds at, TraceBody body, const TrialMeasures& measures,
                    const Trace& trace);
  /// calibrated, instructed, practised, break_taken, paused, stopped, noted: a line of text or "".
  void remarked(std::chrono::nanoseconds at, EventKind kind, const std::string& text);
  /// Seals the chain's length and head up to here into the event, see ChainEnd.
  /// \param complete  whether the schedule was finished
  void closed(std::chrono::nanoseconds at, bool complete);

  /// Hash of the last event; zeros before the first.
  [[nodiscard]] const Digest& head() const noexcept { return head_; }
  [[nodiscard]] std::int64_t length() const noexcept { return length_; }

 private:
  /// An event's secret part, and the padding under which it is sealed.
  struct Secret {
    std::string text;
    std::size_t padding = kEventPadding;
  };
  void append(std::chrono::nanoseconds at, EventKind kind, std::string body, const Secret& secret,
              const std::optional<SealedTrace>& trace = std::nullopt);

  int session_;
  SecretKey participant_key_;
  EventSink& sink_;
  Digest head_{};
  std::int64_t length_ = 0;
  std::chrono::nanoseconds last_at_{0};
};

}  // namespace touchtrial

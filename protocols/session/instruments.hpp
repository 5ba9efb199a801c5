/// \file Instruments that record during a session (EEG, video, physiology): the marks sent to them,
/// and the record of these marks.
#pragma once

#include "device/servo/servo.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/session_clock.hpp"
#include "record/marks.hpp"

#include <chrono>
#include <optional>
#include <vector>

namespace touchtrial::session {

/// The instruments. All functions are thread-safe; only `take` waits.
class Instruments {
 public:
  using Mark = record::Mark;
  using TimePoint = std::chrono::steady_clock::time_point;
  virtual ~Instruments() = default;

  /// \param trial  0 outside trials
  virtual void mark(Mark mark, int trial, TimePoint at) noexcept = 0;
  /// Receives one sample of the servo in the plane frame, in chronological order.
  virtual void feel(const device::ServoSample& sample, TimePoint at) noexcept = 0;

  struct Report {
    /// For each mark since the last call, in order, the time from the event to the end of its
    /// write; empty if there is no line or the write failed.
    std::vector<std::optional<std::chrono::nanoseconds>> latencies;
    /// Time of another clock at the zero of the monotonic clock, s, and its uncertainty.
    std::optional<double> clock_zero_s;
    double clock_uncertainty_s = 0.0;
  };
  /// Waits until all marks are written.
  [[nodiscard]] virtual Report take() = 0;
};

/// Sends marks of a session's events to instruments, and collects the marks for the session's
/// record. The session's thread makes all calls except `note_plane_on` and `feel`.
class SessionMarks {
 public:
  using Mark = record::Mark;
  using TimePoint = Instruments::TimePoint;

  /// \param instruments  null: no mark is sent; otherwise must outlive this
  /// \param session  notifies this object of its inputs; must outlive it
  /// \param rate_hz  of the servo
  SessionMarks(Instruments* instruments, Session& session, double rate_hz);
  ~SessionMarks() { session_.set_observer({}); }
  SessionMarks(const SessionMarks&) = delete;
  SessionMarks& operator=(const SessionMarks&) = delete;

  void begin() { mark(Mark::session_begins, 0, std::chrono::steady_clock::now()); }
  void end() { mark(Mark::session_ends, 0, std::chrono::steady_clock::now()); }
  /// Called on the servo's thread, before its first tick.
  void note_plane_on(TimePoint began) noexcept;
  /// Called on the thread that receives the servo's samples.
  void feel(const device::ServoSample& sample) noexcept;

  /// \param clock  the session's clock, in real time
  /// \return the marks since the last call; nothing if there are none
  [[nodiscard]] std::optional<record::MarksBody> take(SessionClock& clock);

 private:
  void send_mark_of(SessionInput input, int trial);
  void mark(Mark mark, int trial, TimePoint at) noexcept;

  struct SentMark {
    Mark mark{};
    int trial = 0;
    TimePoint at;
  };

  Instruments* instruments_;
  Session& session_;
  double rate_hz_;
  int trial_ = 0;  ///< set between explorations
  TimePoint plane_on_at_;
  bool has_landed_ = false;
  std::vector<SentMark> sent_;  ///< used by several threads, but never concurrently
};

}  // namespace touchtrial::session

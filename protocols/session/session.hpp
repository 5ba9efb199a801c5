/// \file The course of one session: what may happen next, and what is recorded of it.
/// Used by simulated and by real sessions alike; independent of who answers and of any clock.
#pragma once

#include "protocols/design/schedule.hpp"
#include "protocols/store/session_recorder.hpp"

#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace touchtrial {

/// Where a session stands.
enum class SessionPhase {
  fresh,       ///< nothing recorded yet
  opened,      ///< the device is to be calibrated
  calibrated,  ///< the participant is to be instructed
  ready,       ///< between trials
  exploring,   ///< the plane is on
  answering,   ///< the plane is off or fading; no picture chosen yet
  chosen,      ///< a picture is chosen, waiting for Next
  paused,
  finished,  ///< every presentation is done
  stopped,   ///< ended before that
  closed,
};
[[nodiscard]] std::string_view name_of(SessionPhase phase);

/// What can happen to a session.
enum class SessionInput {
  open,
  calibrate,
  instruct,
  present,
  contact,
  end_exploring,
  time_out,
  interrupt,
  store_trace,
  choose,
  confirm,
  take_break,
  pause,
  resume,
  note,
  stop,
  close,
};
[[nodiscard]] std::string_view name_of(SessionInput input);

/// A session as an event-driven state machine that owns the place in the schedule and the recorder.
/// Times come in as arguments: since the session's opening, never decreasing.
///
/// Every input below throws std::logic_error if it does not fit the phase (`accepts` tells before)
/// or its time lies before the last one's, and StoreError if the event could not be stored. Either
/// way nothing has changed then, so that an answer counts, and may be acknowledged on a screen,
/// exactly when `confirm` has returned. Not thread-safe.
class Session {
 public:
  using Time = std::chrono::nanoseconds;

  Session(Schedule schedule, const TrialOptions& options, SessionRecorder recorder);

  [[nodiscard]] SessionPhase phase() const noexcept { return phase_; }
  [[nodiscard]] bool accepts(SessionInput input) const noexcept;
  /// Class index of the picture at each position.
  [[nodiscard]] const std::vector<int>& layout() const noexcept { return schedule_.layout; }
  /// What `present` shows next, or, from `present` to the trial's end, what is shown now; nothing
  /// when all is done.
  [[nodiscard]] const Presentation* current() const noexcept;
  /// Presentations still to be done, the current one included.
  [[nodiscard]] int presentations_left() const noexcept { return static_cast<int>(queue_.size()); }
  /// Whether the study wants a break before the next presentation.
  [[nodiscard]] bool break_due() const noexcept;

  /// \param secret_schedule  schedule_to_json's text, stored sealed
  void open(Time at, const SessionOpening& opening, const std::string& secret_schedule);
  void calibrate(Time at, const std::string& text = "");
  void instruct(Time at, const std::string& text = "");

  /// The plane goes on.
  void present(Time at);
  /// The stylus reaches the plane; only the first time in a presentation is recorded.
  void contact(Time at);
  /// The participant is done exploring.
  void end_exploring(Time at);
  /// Exploration time is up: an answer is still required, or, if the study says no-response, the
  /// presentation is done without one.
  void time_out(Time at);
  /// The presentation was spoilt (a comfort stop, a device fault): it is repeated, under its trial
  /// number, after all others. Not once its trace is stored.
  /// \param reason  in clear: must tell nothing of the stimulus  \param detail  sealed
  void interrupt(Time at, const std::string& reason,
                 const std::optional<InterruptionDetail>& detail = std::nullopt);
  /// The samples of the presentation; once in each.
  void store_trace(Time at, const TraceBody& body, const TrialMeasures& measures,
                   const Trace& trace);

  /// A picture is chosen, by its position in the layout; it can be changed once before `confirm`.
  /// Recorded by `confirm`. \throws std::invalid_argument if there is no such position
  void choose(int position);
  /// Next: records the answer, and the one before a change.
  void confirm(Time at, std::optional<int> confidence = std::nullopt);

  void take_break(Time at, const std::string& text = "");
  /// Between trials or while answering; `resume` goes on where `pause` was.
  void pause(Time at, const std::string& reason);
  void resume(Time at);
  /// A remark, at any time between opening and closing.
  void note(Time at, const std::string& text);
  /// Ends the session early. A presentation that is under way remains without an answer.
  void stop(Time at, const std::string& reason);
  void close(Time at);

 private:
  struct Answer {
    int position = 0;
    std::optional<int> first_position;
  };

  void require(SessionInput input, Time at) const;
  [[nodiscard]] bool is_under_way() const noexcept;
  void move_to(SessionPhase phase, Time at) noexcept;
  void finish_presentation(Time at) noexcept;

  Schedule schedule_;
  TrialOptions options_;
  SessionRecorder recorder_;
  std::deque<std::size_t> queue_;  ///< indices into the schedule, the current one first
  SessionPhase phase_ = SessionPhase::fresh;
  SessionPhase before_pause_ = SessionPhase::ready;
  Time last_{};
  bool had_contact_ = false;
  bool has_trace_ = false;
  std::optional<Answer> answer_;
  int done_since_break_ = 0;
};

}  // namespace touchtrial

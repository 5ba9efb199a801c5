/// \file The blocking operations of a session: showing steps until the participant replies, running
/// explorations, and waiting for the device, while handling the experimenter's requests. It does
/// not decide on trials or stages. Private to protocols/session.
#pragma once

#include "protocols/session/hand_meter.hpp"
#include "protocols/session/instruments.hpp"
#include "protocols/session/session_runner.hpp"

#include <chrono>
#include <deque>
#include <optional>
#include <string>

namespace touchtrial::session {

/// Used only on the session's thread.
class SessionDesk {
 public:
  using Time = SessionClock::Time;

  /// \param session,parts  must outlive this
  SessionDesk(Session& session, const SessionParts& parts);

  [[nodiscard]] Session& session() noexcept { return session_; }
  [[nodiscard]] const SessionParts& parts() const noexcept { return parts_; }

  /// The current time; never before the session's last event.
  [[nodiscard]] Time now();
  /// The time of a reply; neither in the future nor before the session's last event.
  [[nodiscard]] Time time_of(const StepReply& reply);

  /// Shows a new stage to the experimenter.
  void enter(const std::string& stage);
  /// Shows a stage of practice to the experimenter.
  /// \param presentation  number in the round, from 1; 0: none yet
  void enter_practice(const std::string& stage, int presentation, int presentations);
  /// Shows a step until there is a reply, and advances the clock.
  /// \return empty if the step was aborted: the session was stopped or left, or the current
  ///   presentation was interrupted
  [[nodiscard]] std::optional<StepReply> show_step(const Step& step);
  /// Runs an exploration, and advances the clock. In real time, requests of the experimenter end
  /// the exploration or are handled after it.
  /// \param trace  receives every sample
  [[nodiscard]] Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                    const device::ServoOptions& options, record::Trace& trace);
  /// Whether the experimenter's pause ended the last exploration, not the participant.
  [[nodiscard]] bool was_cut_short() const noexcept { return was_cut_short_; }
  /// The number of pauses so far in this run.
  [[nodiscard]] int pauses() const noexcept { return pauses_; }
  /// The options of the session's explorations.
  [[nodiscard]] device::ServoOptions servo_options() const;
  /// Handles the experimenter's requests.
  /// \return whether the current step continues
  [[nodiscard]] bool handle();
  /// Waits until forces may be sent; after a comfort stop, until the participant continues or the
  /// experimenter consents. Pauses the session while the device is not ready.
  /// \return whether forces may be sent
  [[nodiscard]] bool await_device();

  /// Whether the session has been neither stopped, aborted, left nor closed.
  [[nodiscard]] bool is_running() const noexcept;
  /// Why the session was left open; empty if it was not.
  [[nodiscard]] const std::optional<std::string>& leave_reason() const noexcept {
    return leave_reason_;
  }
  /// Marks the session's start and end in the other instruments' records.
  void mark_session_start() { marks_.begin(); }
  void mark_session_end() { marks_.end(); }
  /// Records the marks sent since the last call.
  void record_marks();
  /// Counts an interrupted exploration; the device needs consent before the next one.
  /// \return the reason, which may be stored unencrypted
  [[nodiscard]] std::string note_interruption(const device::ServoReport& report);
  [[nodiscard]] int interruptions() const noexcept { return status_.interruptions; }

 private:
  class AttendedParticipant;
  using Request = ExperimenterRequest;

  /// Called repeatedly in real time while the plane is on.
  void poll_experimenter(device::ServoControl& servo);
  [[nodiscard]] bool end_is_postponed() const noexcept;
  /// Ends the exploration if the request requires it. Postpones events that must be recorded.
  void handle_while_exploring(Request request, device::ServoControl& servo);
  [[nodiscard]] std::optional<Request> next_request();
  [[nodiscard]] bool handle(const Request& request);
  [[nodiscard]] bool handle_pause(const Request& request);
  [[nodiscard]] bool handle_delay(const Request& request);
  [[nodiscard]] bool handle_comfort_stop(const Request& request);
  [[nodiscard]] bool handle_abort(const Request& request);
  [[nodiscard]] bool leave(const std::string& reason);
  [[nodiscard]] bool wait_for_device(SupplyState device);
  /// The participant's page while the device is not ready.
  [[nodiscard]] Step waiting_page() const;
  /// After a comfort stop, shows the participant a page until they continue.
  /// \return whether they continue; true immediately if there was no stop
  [[nodiscard]] bool wait_for_consent();
  [[nodiscard]] std::string count_interruption(const std::string& reason);
  /// Shows the session's state to the experimenter.
  void show();
  void show_at_intervals();
  void sleep_briefly() const;

  Session& session_;
  const SessionParts& parts_;
  SessionMarks marks_;
  std::optional<std::string> leave_reason_;
  bool is_aborted_ = false;  ///< aborted after the last trial, so that the session stays complete
  SessionStatus status_;
  HandMeter hand_meter_;
  std::deque<Request> postponed_;
  std::optional<std::string> reason_;  ///< the experimenter's reason for an interruption
  bool is_stopped_ = false;            ///< a comfort stop is pending
  bool is_participants_stop_ = false;  ///< whether the participant requested the comfort stop
  bool announces_next_ = false;        ///< whether the next presentation is announced
  bool was_cut_short_ = false;
  int pauses_ = 0;
  std::chrono::steady_clock::time_point last_shown_{};
};

}  // namespace touchtrial::session

/// \file Everything in a session that takes time: it shows steps to the participant until they
/// reply, runs explorations, waits for the device, and handles the experimenter's requests
/// meanwhile. It does not decide on trials or stages. Private to protocols/session.
#pragma once

#include "protocols/session/hand_meter.hpp"
#include "protocols/session/instruments.hpp"
#include "protocols/session/session_runner.hpp"

#include <chrono>
#include <deque>
#include <optional>
#include <string>

namespace touchtrial::session {

/// Belongs to the session's thread.
class SessionDesk {
 public:
  using Time = SessionClock::Time;

  /// \param session,parts  must outlive this
  SessionDesk(Session& session, const SessionParts& parts);

  [[nodiscard]] Session& session() noexcept { return session_; }
  [[nodiscard]] const SessionParts& parts() const noexcept { return parts_; }

  /// The time; never before the session's last event.
  [[nodiscard]] Time now();
  /// The time of a reply; neither in the future nor before the session's last event.
  [[nodiscard]] Time when(const StepReply& reply);

  /// Shows a new stage to the experimenter.
  void enter(const std::string& stage);
  /// The same in practice.
  /// \param presentation  of the round, from 1; 0: none yet
  void enter_practice(const std::string& stage, int presentation, int of);
  /// Shows a step until there is a reply, and advances the clock.
  /// \return empty if the step was aborted: the session was stopped or left, or the current
  ///   presentation was interrupted
  [[nodiscard]] std::optional<StepReply> attend(const Step& step);
  /// Runs an exploration, and advances the clock. In real time the experimenter's requests end it,
  /// or are handled after it.
  /// \param trace  gets every sample
  [[nodiscard]] Exploration explore(device::ForceSource& force, const PlaneGeometry& plane,
                                    const device::ServoOptions& options, record::Trace& trace);
  /// Whether the experimenter's pause ended the last exploration, and not the participant.
  [[nodiscard]] bool was_cut_short() const noexcept { return was_cut_short_; }
  /// Pauses of this run so far.
  [[nodiscard]] int pauses() const noexcept { return pauses_; }
  /// The options of the session's explorations.
  [[nodiscard]] device::ServoOptions servo_options() const;
  /// Handles the experimenter's requests.
  /// \return whether the current step continues
  [[nodiscard]] bool handle();
  /// Waits until forces may be sent, and after a comfort stop until the participant continues or
  /// the experimenter consents. Pauses the session meanwhile if the device is not ready.
  /// \return whether forces may be sent
  [[nodiscard]] bool await_device();

  /// Whether the session was neither stopped nor aborted nor left.
  [[nodiscard]] bool is_running() const noexcept;
  /// Why the session is left open; empty if it is not.
  [[nodiscard]] const std::optional<std::string>& left() const noexcept { return left_; }
  /// Marks the session's start and end in the other instruments' records.
  void mark_session_start() { marks_.begin(); }
  void mark_session_end() { marks_.end(); }
  /// Records the marks sent since the last call.
  void record_marks();
  /// Counts an interrupted exploration; the device needs consent before the next one.
  /// \return the reason, in clear
  [[nodiscard]] std::string note_interruption(const device::ServoReport& report);
  [[nodiscard]] int interruptions() const noexcept { return status_.interruptions; }

 private:
  class AttendedParticipant;
  using Request = ExperimenterRequest;

  /// Called repeatedly in real time while the plane is on.
  void look(device::ServoControl& servo);
  [[nodiscard]] bool end_is_postponed() const noexcept;
  /// Ends the exploration if a request requires it. Postpones what has to be recorded.
  void handle_while_exploring(Request request, device::ServoControl& servo);
  [[nodiscard]] std::optional<Request> next_request();
  [[nodiscard]] bool handle(const Request& request);
  [[nodiscard]] bool handle_pause(const Request& request);
  [[nodiscard]] bool handle_delay(const Request& request);
  [[nodiscard]] bool handle_comfort_stop(const Request& request);
  [[nodiscard]] bool handle_abort(const Request& request);
  [[nodiscard]] bool leave(const std::string& why);
  [[nodiscard]] bool wait_for_device(SupplyState device);
  /// What the participant sees while the device is not ready.
  [[nodiscard]] Step waiting_page() const;
  /// Shows the participant a page about a comfort stop until they continue.
  /// \return whether they continue; true at once if there was no stop
  [[nodiscard]] bool wait_for_consent();
  [[nodiscard]] std::string count_interruption(const std::string& words);
  void show();
  void show_now_and_then();
  void sleep_briefly() const;

  Session& session_;
  const SessionParts& parts_;
  SessionMarks marks_;
  std::optional<std::string> left_;
  bool is_aborted_ = false;  ///< after the last trial, when there is nothing left to stop
  SessionStatus status_;
  HandMeter hand_;
  std::deque<Request> postponed_;
  std::optional<std::string> reason_;  ///< of an interruption that the experimenter asked for
  bool is_stopped_ = false;            ///< a comfort stop is pending
  bool is_participants_stop_ =
      false;                ///< the comfort stop is the participant's, not the experimenter's
  bool announces_ = false;  ///< the next presentation is announced
  bool was_cut_short_ = false;
  int pauses_ = 0;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace touchtrial::session

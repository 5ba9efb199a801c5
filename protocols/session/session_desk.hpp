/// \file Where a session's people are attended to: steps are put before the participant until they
/// reply, and the experimenter's requests are obeyed meanwhile. Private to the runner.
#pragma once

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

  SessionDesk(Session& session, const SessionParts& parts);

  [[nodiscard]] Session& session() noexcept { return session_; }
  [[nodiscard]] const SessionParts& parts() const noexcept { return parts_; }
  [[nodiscard]] SessionTally& tally() noexcept { return tally_; }

  /// Never before the session's last event.
  [[nodiscard]] Time now();
  /// When a reply was given: neither in the future nor before the last event.
  [[nodiscard]] Time when(const StepReply& reply);

  /// The session has come to another stage; the experimenter sees it.
  void enter(const std::string& stage, bool practice = false);
  /// \return nothing if the step was broken off: the session was stopped or left, or what was
  ///   under way was interrupted
  [[nodiscard]] std::optional<StepReply> attend(const Step& step);
  /// While the plane is on, in real time: what the experimenter asks for ends the exploration, or
  /// waits for its end.
  void look(device::ServoControl& servo);
  /// Obeys what is asked for. \return whether what was under way goes on
  [[nodiscard]] bool obey();
  /// Waits until forces may be sent; the session is paused meanwhile if it can be.
  /// \return whether they may
  [[nodiscard]] bool await_device();

  /// Neither stopped nor aborted nor left.
  [[nodiscard]] bool goes_on() const noexcept;
  /// An exploration was interrupted; what for, in clear. \param words  that of the servo
  [[nodiscard]] std::string note_interruption(const std::string& words);
  [[nodiscard]] int interruptions() const noexcept { return status_.interruptions; }
  /// How the servo kept time in the last exploration.
  void saw_servo(const device::ServoReport& report);

 private:
  using Request = ExperimenterRequest;

  [[nodiscard]] bool end_is_postponed() const noexcept;
  /// One request while the plane is on.
  void heed(Request request, device::ServoControl& servo);
  [[nodiscard]] std::optional<Request> next_request();
  [[nodiscard]] bool obey(const Request& request);
  [[nodiscard]] bool obey_pause(const Request& request);
  [[nodiscard]] bool obey_comfort_stop(const Request& request);
  [[nodiscard]] bool obey_abort(const Request& request);
  [[nodiscard]] bool leave(const std::string& why);
  [[nodiscard]] bool wait_for_device(SupplyState device);
  void show();
  void show_now_and_then();
  void breathe() const;

  Session& session_;
  const SessionParts& parts_;
  SessionTally tally_;
  bool is_aborted_ = false;  ///< after the last trial, when there is nothing left to stop
  SessionStatus status_;
  std::deque<Request> postponed_;
  std::optional<std::string> reason_;  ///< of the interruption that the experimenter asked for
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace touchtrial::session

/// \file One presentation: ready, explore, answer. Private to the runner.
#pragma once

#include "protocols/session/attended_exploring.hpp"
#include "protocols/session/exploration_record.hpp"
#include "protocols/session/session_desk.hpp"

namespace touchtrial::session {

/// The servo's options of a session's explorations: the study's limits, or the lab's where they are
/// stricter.
[[nodiscard]] device::ServoOptions servo_options(const SessionParts& parts);

/// The trials of a session, one after the other.
class TrialRun {
 public:
  explicit TrialRun(SessionDesk& desk);

  /// The current presentation, as far as it goes. \pre the session is ready
  void run();

 private:
  /// \return whether the participant is to answer
  [[nodiscard]] bool explore(const engine::RenderingModel& model);
  [[nodiscard]] bool explore_again(const engine::RenderingModel& model);
  [[nodiscard]] bool end_exploration(const Exploration& done, SessionClock::Time plane_on);
  void answer(const engine::RenderingModel& model);
  void confirm(const StepReply& reply);
  void keep_evidence();
  [[nodiscard]] AnswerStep question() const;
  [[nodiscard]] const engine::RenderingModel& model() const;

  SessionDesk& desk_;
  Session& session_;
  const SessionParts& parts_;
  AttendedExploring participant_;
  device::ServoOptions servo_;
  ExplorationRecord record_;
  int of_ = 0;  ///< presentations that there will be
  bool time_is_up_ = false;
};

}  // namespace touchtrial::session

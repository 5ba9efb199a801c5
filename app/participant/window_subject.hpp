/// \file A simulated participant before the same window as people.
#pragma once

#include "app/participant/participant_window.hpp"
#include "protocols/session/participant.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Asks the participant for each reply, and gives it with the window's keys; what the window makes
/// of them is what the session gets. All functions belong to the session's thread, but `feel`.
class WindowSubject final : public session::Participant {
 public:
  /// \param window,subject  must outlive this
  /// \param real_time  false: replies bear no time of their own, but the subject's thinking time
  WindowSubject(ParticipantWindow& window, session::Participant& subject, bool real_time);

  void see_pictures(const std::vector<std::string>& labels) override;
  [[nodiscard]] std::optional<session::StepReply> attend(const session::Step& step) override;
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override;
  void exploring(device::ServoControl& servo) override;
  void feel(const device::ServoSample& sample) noexcept override;

 private:
  void type(const session::Step& step, const session::StepReply& reply);
  void forget();
  void press(Key key, int digit = 0);

  ParticipantWindow& window_;
  session::Participant& subject_;
  bool real_time_;
  std::optional<session::StepReply> meant_;  ///< the window has not replied yet
  bool typed_ = false;                       ///< what is meant, into the window
};

}  // namespace touchtrial::app

/// \file A simulated participant who uses the same window as people do.
#pragma once

#include "app/participant/participant_window.hpp"
#include "protocols/session/participant.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Asks the participant for each reply and types it into the window; the session gets the window's
/// reply. All functions but `feel` belong to the session's thread.
class WindowSubject final : public session::Participant {
 public:
  /// \param window,subject  must outlive this object
  /// \param real_time  false: replies have no time stamp, but the subject's thinking time
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
  std::optional<session::Step> step_;        ///< the last one
  std::optional<session::StepReply> meant_;  ///< the subject's reply, until the window replies
  bool typed_ = false;                       ///< whether it was typed
};

}  // namespace touchtrial::app

/// \file Whoever feels planes and names pictures.
#pragma once

#include "core/plane_geometry.hpp"
#include "device/haptic_device.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_control.hpp"
#include "protocols/session/step.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::session {

/// All that reaches a participant is in these calls: the pictures to choose from, the extent of the
/// blank plane (the same in every trial), and what the device lets them feel. No code, label or
/// file name of what is presented. Called on the session's thread but for `feel`.
class Participant {
 public:
  virtual ~Participant() = default;

  /// The pictures' labels, by position: before the first trial, and, if there is practice, those of
  /// the practice before it.
  virtual void see_pictures(const std::vector<std::string>& labels) = 0;

  /// Puts a step before the participant. Called over and over with the same step until there is a
  /// reply; the first call shows it. May block for a moment, as a screen does that draws.
  /// \return nothing as long as they have not replied
  [[nodiscard]] virtual std::optional<StepReply> attend(const Step& step) = 0;

  /// A plane is about to be on. \return the device with the participant's hand on it, in the plane
  ///   frame; it may report stopped when the participant is done exploring. Valid until the next
  ///   call.
  [[nodiscard]] virtual device::HapticDevice& begin_exploring(const PlaneGeometry& plane) = 0;

  /// In real time, while the plane is on: called over and over, to look for what the person does.
  /// Whoever is done calls `finish`, whoever wants no force `comfort_stop`.
  virtual void exploring(device::ServoControl& /*servo*/) {}

  /// One tick of what the device did. In virtual time on the servo's thread; in real time behind
  /// it, on a thread of its own, over before the next step.
  virtual void feel(const device::ServoSample& sample) noexcept = 0;
};

}  // namespace touchtrial::session

/// \file Whoever feels planes and names pictures.
#pragma once

#include "core/plane_geometry.hpp"
#include "device/haptic_device.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_control.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace touchtrial {

/// A choice, and the time that it took after exploring.
struct ParticipantAnswer {
  int position = 0;  ///< index into the pictures, from 0
  std::chrono::nanoseconds thought{};
};

/// All that reaches a participant is in these calls: the pictures to choose from, the extent of the
/// blank plane (the same in every trial), and what the device lets them feel. No code, label or
/// file name of what is presented.
class Participant {
 public:
  virtual ~Participant() = default;

  /// The pictures' labels, by position; once, before the first trial.
  virtual void see_pictures(const std::vector<std::string>& labels) = 0;

  /// A plane is about to be on. \return the device with the participant's hand on it, in the plane
  ///   frame; it may report stopped when the participant is done exploring. Valid until the next
  ///   call.
  [[nodiscard]] virtual HapticDevice& begin_exploring(const PlaneGeometry& plane) = 0;

  /// In real time, while the plane is on: called over and over on the session's thread, to look for
  /// what the person does. Whoever is done calls `finish`, whoever wants no force `comfort_stop`.
  virtual void exploring(ServoControl& /*servo*/) {}

  /// One tick of what the device did. In virtual time on the servo's thread; in real time behind
  /// it, on a thread of its own, over before `answer` is called.
  virtual void feel(const ServoSample& sample) noexcept = 0;

  /// A break: returns when the participant goes on.
  virtual void rest() {}

  /// The choice after exploring.
  [[nodiscard]] virtual ParticipantAnswer answer() = 0;
};

}  // namespace touchtrial

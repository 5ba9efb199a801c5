/// \file The inverse of the driver's kinematics: a Falcon's joint angles from a hand's position, in
/// closed form. Source: as falcon_kinematics.hpp.
#pragma once

#include "device/falcon/falcon_kinematics.hpp"

#include <array>
#include <optional>

namespace touchtrial::device::falcon {

[[nodiscard]] constexpr Vec3 to_native_m(Vec3 device_mm) noexcept {
  return 0.001 * device_mm + kCentreM;
}

struct LegAngles {
  double theta1_rad = 0.0;  ///< arm
  double theta2_rad = 0.0;  ///< parallelogram, within the leg's plane
  double theta3_rad = 0.0;  ///< parallelogram, out of the leg's plane; pi / 2 is upright
};
using Legs = std::array<LegAngles, 3>;

/// \return the joint angles; nothing if the position is out of reach or not finite
[[nodiscard]] std::optional<Legs> inverse_kinematics(Vec3 native_m) noexcept;

/// \return the legs' action on the hand, from their angles
[[nodiscard]] LegJacobian leg_jacobian(const Legs& legs) noexcept;

}  // namespace touchtrial::device::falcon

/// \file A reference for the driver's kinematics, slow and obvious: the legs by the law of cosines,
/// and differentials by differences.
#pragma once

#include "core/vec.hpp"
#include "device/drivers/falcon/falcon_kinematics.hpp"

#include <array>
#include <optional>

namespace touchtrial::device::falcon {

[[nodiscard]] constexpr Vec3 to_native_m(Vec3 device_mm) noexcept {
  return 0.001 * device_mm + kCentreM;
}

/// \return theta1 of the three legs, rad, at a native position, m; nothing out of reach
[[nodiscard]] std::optional<std::array<double, 3>> reference_theta1(Vec3 native_m);

/// \return d theta1_i / d position, rad/m, by central differences; nothing near the edge of the
/// reach
[[nodiscard]] std::optional<std::array<Vec3, 3>> reference_rows(Vec3 native_m);

/// \return the force on the hand, N, from motor torques, N m: F = sum of torque_i d theta1_i / d
///   position; nothing near the edge of the reach
[[nodiscard]] std::optional<Vec3> reference_force_n(Vec3 native_m,
                                                    const std::array<double, 3>& torques_nm);

}  // namespace touchtrial::device::falcon

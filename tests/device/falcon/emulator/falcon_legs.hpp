/// \file A Falcon's legs in another way than the driver's: by the law of cosines, and differentials
/// by differences. Slow and obvious; the driver is held against it.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <optional>

namespace touchtrial::device::falcon {

/// theta1 of the three legs, rad, at a native position, m. \return nothing out of reach
[[nodiscard]] std::optional<std::array<double, 3>> reference_theta1(Vec3 native_m);

/// d theta1_i / d position, rad/m, by central differences. \return nothing near the reach's edge
[[nodiscard]] std::optional<std::array<Vec3, 3>> reference_rows(Vec3 native_m);

/// The force on the hand, N, from motor torques, N m: F = sum of torque_i d theta1_i / d position.
/// \return nothing near the reach's edge
[[nodiscard]] std::optional<Vec3> reference_force_n(Vec3 native_m,
                                                    const std::array<double, 3>& torques_nm);

}  // namespace touchtrial::device::falcon

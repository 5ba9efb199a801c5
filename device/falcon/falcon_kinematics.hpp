/// \file Geometry of the Novint Falcon: joint angles to hand position, force to motor torques.
///
/// Three equal legs stand around the device's axis. In the plane of a leg an arm of length a turns
/// by theta1 (its motor); a parallelogram, tilted by theta3 out of that plane, leads from the arm's
/// end to the grip at the angle theta2. Source: R. E. Stamper, "A three degree of freedom parallel
/// manipulator with only translational degrees of freedom", University of Maryland, 1997; the
/// constants are those that the open drivers use. Not verified on hardware.
///
/// Two frames. Native, m: z along the device's axis towards the person, measured from the base.
/// Device, mm: the frame of HapticDevice. Only `to_device_mm` knows both.
///
/// Everything here is a pure function: any thread, no heap, no throw, bounded time.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace touchtrial::device::falcon {

using EncoderCounts = std::array<std::int16_t, 3>;
using PerLeg = std::array<double, 3>;

/// Native place of the device frame's origin: the middle of what the legs reach on the axis, where
/// theta1 exists for z from 59.8 to 183.2 mm.
inline constexpr Vec3 kCentreM = {0.0, 0.0, 0.1215};
/// Every position nearer to the origin of the device frame than this is in reach, mm.
inline constexpr double kWorkspaceRadiusMm = 40.0;

[[nodiscard]] constexpr Vec3 to_device_mm(Vec3 native_m) noexcept {
  return 1000.0 * (native_m - kCentreM);
}

/// theta1 at an encoder's count, rad. Counts hold once the axis is homed.
[[nodiscard]] double theta1_of_count(std::int16_t count) noexcept;
[[nodiscard]] PerLeg theta1_of_counts(const EncoderCounts& counts) noexcept;

/// How the legs act on the hand at one pose:
/// d theta1_i / d position = pull_i / lever_i, in rad/m.
struct LegJacobian {
  std::array<Vec3, 3> pull;  ///< dimensionless, native axes
  PerLeg lever_m{};          ///< 0 where an arm and its parallelogram are in line
};

/// Motor torques, N m, that make the hand feel a force: J^T F with J = d position / d theta1.
/// \param force_n  on the hand; native and device axes are parallel
/// \return nothing if the legs cannot hold that pose (singular), or anything is not finite
[[nodiscard]] std::optional<PerLeg> torques_nm(const LegJacobian& jacobian, Vec3 force_n) noexcept;

enum class PoseStatus {
  ok,
  out_of_reach,  ///< no position belongs to these angles, so they are no reading of a Falcon
  singular,      ///< position found, but forces there have no torques
};

struct Pose {
  PoseStatus status = PoseStatus::out_of_reach;
  Vec3 native_m = kCentreM;  ///< the centre if out of reach
  LegJacobian jacobian;      ///< there
  int iterations = 0;        ///< Newton steps taken, both attempts together
};

/// Forward kinematics: Newton on the three legs' closure, steps capped at 20 mm and halved until
/// the closure improves. Ends within 1e-12 m of closure.
/// \param start_m  the last position, for speed (<= 3 steps for what a hand does in a
///                 millisecond); if that leads nowhere, the centre is tried
[[nodiscard]] Pose forward_kinematics(const PerLeg& theta1_rad, Vec3 start_m = kCentreM) noexcept;

}  // namespace touchtrial::device::falcon

/// \file Geometry of the Novint Falcon: joint angles to hand position, force to motor torques.
///
/// Three equal legs are arranged around the device's axis. In the plane of a leg, the motor rotates
/// an arm by theta1; a parallelogram, which can swing sideways, connects the arm's end to the grip.
/// The grip does not rotate, so it is at the intersection of three spheres around the arms' ends,
/// each shifted by the leg's offset. Source: R. Clavel, "Delta, a fast robot with parallel
/// geometry", ISIR 1988. Lengths and angles were read from Force Dimension's library 3.17.5, which
/// can drive a Falcon (docs/devices/falcon.md). Not verified on hardware.
///
/// Frames: native, m, with z along the device's axis towards the person, measured from the arms'
/// axes; and device, mm, as in HapticDevice. `to_device_mm` converts.
///
/// All functions are pure: any thread, no allocation or exception, constant time.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <cstdint>
#include <numbers>
#include <optional>

namespace touchtrial::device::falcon {

using EncoderCounts = std::array<std::int16_t, 3>;
using PerLeg = std::array<double, 3>;

/// The device frame's origin in the native frame, on the axis, where theta1 is 25.4 degrees.
inline constexpr Vec3 kCentreM = {0.0, 0.0, 0.155};
/// Every position within this distance of the device frame's origin is reachable, mm.
inline constexpr double kWorkspaceRadiusMm = 40.0;

[[nodiscard]] constexpr Vec3 to_device_mm(Vec3 native_m) noexcept {
  return 1000.0 * (native_m - kCentreM);
}

/// \name Lengths and angles of the legs, and the frame of each leg
///@{
inline constexpr double kArmM = 0.060;
inline constexpr double kParallelogramM = 0.150;
/// The distance from the device's axis to an arm's axis, minus that from the grip's centre to its
/// joint.
inline constexpr double kOffsetM = 0.022;

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Cosine and sine of a leg's angle phi around the axis: 104.5, -15.5, -135.5 degrees.
struct LegDirection {
  double cosine;
  double sine;
};
inline constexpr std::array<LegDirection, 3> kLegDirections = {
    {{-0.2503800040544414, 0.9681476403781077},
     {0.963630453208623, -0.26723837607825685},
     {-0.7132504491541815, -0.700909264299851}}};

/// A position in the frame of one leg.
struct LegPoint {
  double across_m;  ///< in the leg's plane, outwards, from the arm's axis to the grip's joint
  double side_m;    ///< out of the leg's plane
  double along_m;   ///< along the device's axis
};

[[nodiscard]] inline LegPoint to_leg_frame(Vec3 native_m, const LegDirection& leg) noexcept {
  return {native_m.x * leg.cosine + native_m.y * leg.sine - kOffsetM,
          -native_m.x * leg.sine + native_m.y * leg.cosine, native_m.z};
}

/// \param direction  in a leg's frame: across, side, along
[[nodiscard]] inline Vec3 to_native_axes(Vec3 direction, const LegDirection& leg) noexcept {
  return {direction.x * leg.cosine - direction.y * leg.sine,
          direction.x * leg.sine + direction.y * leg.cosine, direction.z};
}
///@}

/// \return theta1 at an encoder's count, rad; valid once the axis is homed
[[nodiscard]] double theta1_of_count(std::int16_t count) noexcept;
[[nodiscard]] PerLeg theta1_of_counts(const EncoderCounts& counts) noexcept;

/// The Jacobian of the legs' angles at one pose: d theta1_i / d position = pull_i / lever_i, rad/m.
struct LegJacobian {
  std::array<Vec3, 3> pull;  ///< of length 1, native axes
  PerLeg lever_m{};          ///< 0 where an arm and its parallelogram are in line
};

/// \param force_n  on the hand; native and device axes are parallel
/// \return the motor torques that exert the force, N m: J^T F with J = d position / d theta1; nothing
///   in a singular pose, or if a number is not finite
[[nodiscard]] std::optional<PerLeg> torques_nm(const LegJacobian& jacobian, Vec3 force_n) noexcept;

enum class PoseStatus {
  ok,
  out_of_reach,  ///< no position has these angles, so the reading is invalid
  singular,      ///< the position exists, but torques cannot produce every force there
};

struct Pose {
  PoseStatus status = PoseStatus::out_of_reach;
  Vec3 native_m = kCentreM;  ///< the centre if out of reach
  LegJacobian jacobian;      ///< at that position
};

/// Finds the position at which the legs' three spheres intersect, on the person's side.
[[nodiscard]] Pose forward_kinematics(const PerLeg& theta1_rad) noexcept;

}  // namespace touchtrial::device::falcon

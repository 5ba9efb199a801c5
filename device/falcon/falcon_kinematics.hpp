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
#include <numbers>
#include <optional>

namespace touchtrial::device::falcon {

using EncoderCounts = std::array<std::int16_t, 3>;
using PerLeg = std::array<double, 3>;

/// The device frame's origin in the native frame: the middle of the legs' reach on the axis, where
/// theta1 exists for z from 59.8 to 183.2 mm.
inline constexpr Vec3 kCentreM = {0.0, 0.0, 0.1215};
/// Every position nearer to the origin of the device frame than this is in reach, mm.
inline constexpr double kWorkspaceRadiusMm = 40.0;

[[nodiscard]] constexpr Vec3 to_device_mm(Vec3 native_m) noexcept {
  return 1000.0 * (native_m - kCentreM);
}

/// \name Lengths and angles of the legs, and the frame of each leg
///@{
inline constexpr double kArmM = 0.060;             ///< a
inline constexpr double kParallelogramM = 0.1025;  ///< b
inline constexpr double kGripOffsetM = 0.01443;    ///< c
inline constexpr double kEndLinkM = 0.01125;       ///< d and e, at either end of the parallelogram
inline constexpr double kSideOffsetM = -0.025;     ///< f
inline constexpr double kBaseRadiusM = 0.040;      ///< r
inline constexpr double kBaseShiftM = -0.02309;    ///< s

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Cosine and sine of a leg's angle phi around the axis: 105, -15, -135 degrees.
struct LegDirection {
  double cosine;
  double sine;
};
inline constexpr std::array<LegDirection, 3> kLegDirections = {
    {{-0.25881904510252076, 0.9659258262890683},
     {0.9659258262890683, -0.25881904510252076},
     {-0.7071067811865476, -0.7071067811865476}}};

/// A position in the frame of one leg.
struct LegPoint {
  double across_m;  ///< U: in the leg's plane, outwards, from the arm's axis to the grip's joint
  double side_m;    ///< v + f: out of the leg's plane
  double along_m;   ///< w: along the device's axis
};

[[nodiscard]] inline LegPoint seen_by_leg(Vec3 native_m, const LegDirection& leg) noexcept {
  const double outwards = native_m.x * leg.cosine + native_m.y * leg.sine;
  const double sideways = -native_m.x * leg.sine + native_m.y * leg.cosine;
  return {outwards - kBaseRadiusM + kGripOffsetM, sideways - kBaseShiftM + kSideOffsetM,
          native_m.z};
}

/// A direction of a leg's frame (across, side, along) in native axes.
[[nodiscard]] inline Vec3 to_native_axes(Vec3 in_leg, const LegDirection& leg) noexcept {
  return {in_leg.x * leg.cosine - in_leg.y * leg.sine, in_leg.x * leg.sine + in_leg.y * leg.cosine,
          in_leg.z};
}
///@}

/// \return theta1 at an encoder's count, rad; valid once the axis is homed
[[nodiscard]] double theta1_of_count(std::int16_t count) noexcept;
[[nodiscard]] PerLeg theta1_of_counts(const EncoderCounts& counts) noexcept;

/// How the legs act on the hand at one pose:
/// d theta1_i / d position = pull_i / lever_i, in rad/m.
struct LegJacobian {
  std::array<Vec3, 3> pull;  ///< dimensionless, native axes
  PerLeg lever_m{};          ///< 0 where an arm and its parallelogram are in line
};

/// Motor torques that make the hand feel a force: J^T F with J = d position / d theta1.
/// \param force_n  on the hand; native and device axes are parallel
/// \return N m; nothing if the legs cannot hold that pose (singular), or a number is not finite
[[nodiscard]] std::optional<PerLeg> torques_nm(const LegJacobian& jacobian, Vec3 force_n) noexcept;

enum class PoseStatus {
  ok,
  out_of_reach,  ///< no position has these angles, so they are not a Falcon's reading
  singular,      ///< the position exists, but no torques give a force there
};

struct Pose {
  PoseStatus status = PoseStatus::out_of_reach;
  Vec3 native_m = kCentreM;  ///< the centre if out of reach
  LegJacobian jacobian;      ///< at that position
  int iterations = 0;        ///< Newton steps taken, both attempts together
};

/// Forward kinematics: Newton on the three legs' closure, steps capped at 20 mm and halved until
/// the closure improves. Ends within 1e-12 m of closure.
/// \param start_m  the last position, for speed: a hand's motion in a millisecond takes <= 3 steps;
///   if the start leads nowhere, Newton begins again at the centre
[[nodiscard]] Pose forward_kinematics(const PerLeg& theta1_rad, Vec3 start_m = kCentreM) noexcept;

}  // namespace touchtrial::device::falcon

/// \file Lengths and angles of a Falcon's legs, and the frame of each leg. Private to this folder.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <numbers>

namespace touchtrial::device::falcon {

inline constexpr double kArmM = 0.060;             ///< a
inline constexpr double kParallelogramM = 0.1025;  ///< b
inline constexpr double kGripOffsetM = 0.01443;    ///< c
inline constexpr double kEndLinkM = 0.01125;       ///< d and e, at either end of the parallelogram
inline constexpr double kSideOffsetM = -0.025;     ///< f
inline constexpr double kBaseRadiusM = 0.040;      ///< r
inline constexpr double kBaseShiftM = -0.02309;    ///< s

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// Cosine and sine of the angle phi at which a leg stands around the axis: 105, -15, -135 degrees.
struct LegDirection {
  double cosine;
  double sine;
};
inline constexpr std::array<LegDirection, 3> kLegDirections = {
    {{-0.25881904510252076, 0.9659258262890683},
     {0.9659258262890683, -0.25881904510252076},
     {-0.7071067811865476, -0.7071067811865476}}};

/// A position as one leg sees it.
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

}  // namespace touchtrial::device::falcon

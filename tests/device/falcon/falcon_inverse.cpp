#include "device/falcon/falcon_inverse.hpp"

#include "device/falcon/falcon_kinematics.hpp"

#include <cmath>
#include <cstddef>

namespace touchtrial::device::falcon {
namespace {

std::optional<LegAngles> angles_of_leg(const LegPoint& p) noexcept {
  const double side = p.side_m / kParallelogramM;
  if (!(std::abs(side) < 1.0) || !(p.along_m > 0.0)) return std::nullopt;
  const double theta3 = std::acos(side);
  const double reach = kParallelogramM * std::sin(theta3);
  const double a2 = 2.0 * kArmM * p.across_m;
  const double sum =
      p.along_m * p.along_m + p.across_m * p.across_m + kArmM * kArmM - reach * reach;
  const double half = 4.0 * kArmM * p.along_m;
  const double discriminant = half * half - 4.0 * (sum - a2) * (sum + a2);
  if (!(discriminant >= 0.0)) return std::nullopt;
  // The smaller root of (sum + a2) t^2 - half t + (sum - a2) = 0, t = tan(theta1 / 2), in the form
  // that stays exact where sum + a2 is zero.
  const double theta1 = 2.0 * std::atan(2.0 * (sum - a2) / (half + std::sqrt(discriminant)));
  const double across = p.across_m - kArmM * std::cos(theta1);
  const double along = p.along_m - kArmM * std::sin(theta1);
  if (!(along > 0.0)) return std::nullopt;
  return LegAngles{theta1, std::atan2(along, across), theta3};
}

}  // namespace

std::optional<Legs> inverse_kinematics(Vec3 native_m) noexcept {
  Legs legs;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto angles = angles_of_leg(seen_by_leg(native_m, kLegDirections[i]));
    if (!angles) return std::nullopt;
    legs[i] = *angles;
  }
  return legs;
}

LegJacobian leg_jacobian(const Legs& legs) noexcept {
  LegJacobian jacobian;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [theta1, theta2, theta3] = legs[i];
    const Vec3 in_leg = {std::sin(theta3) * std::cos(theta2), std::cos(theta3),
                         std::sin(theta3) * std::sin(theta2)};
    jacobian.pull[i] = to_native_axes(in_leg, kLegDirections[i]);
    jacobian.lever_m[i] = kArmM * std::sin(theta3) * std::sin(theta2 - theta1);
  }
  return jacobian;
}

}  // namespace touchtrial::device::falcon

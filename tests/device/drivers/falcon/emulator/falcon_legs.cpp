#include "device/drivers/falcon/emulator/falcon_legs.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace touchtrial::device::falcon {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

std::optional<double> theta1_of_leg(Vec3 p, double phi) {
  const double grip = p.x * std::cos(phi) + p.y * std::sin(phi) - 0.022;
  const double side = -p.x * std::sin(phi) + p.y * std::cos(phi);
  if (std::abs(side) >= 0.150 || p.z <= 0.0) return std::nullopt;
  // A triangle: the arm, the parallelogram, and the line from the arm's axis to the grip's joint.
  const double parallelogram_square = 0.150 * 0.150 - side * side;
  const double line = std::hypot(grip, p.z);
  const double cosine = (line * line + 0.060 * 0.060 - parallelogram_square) / (2.0 * 0.060 * line);
  if (!(std::abs(cosine) <= 1.0)) return std::nullopt;
  return std::atan2(p.z, grip) - std::acos(cosine);
}

Vec3 along_axis(std::size_t axis, double length) {
  return {axis == 0 ? length : 0.0, axis == 1 ? length : 0.0, axis == 2 ? length : 0.0};
}

}  // namespace

std::optional<std::array<double, 3>> reference_theta1(Vec3 native_m) {
  std::array<double, 3> angles{};
  const std::array<double, 3> phi = {104.5 * kDeg, -15.5 * kDeg, -135.5 * kDeg};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto angle = theta1_of_leg(native_m, phi[i]);
    if (!angle) return std::nullopt;
    angles[i] = *angle;
  }
  return angles;
}

std::optional<std::array<Vec3, 3>> reference_rows(Vec3 native_m) {
  constexpr double kStepM = 2e-6;  // errors of about 1e-9 rad/m, from rounding and curvature alike
  std::array<std::array<double, 3>, 3> slopes{};  // of the axis, of the leg
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto before = reference_theta1(native_m - along_axis(axis, kStepM));
    const auto after = reference_theta1(native_m + along_axis(axis, kStepM));
    if (!before || !after) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
      slopes[axis][i] = ((*after)[i] - (*before)[i]) / (2.0 * kStepM);
    }
  }
  std::array<Vec3, 3> rows;
  for (std::size_t i = 0; i < 3; ++i) rows[i] = {slopes[0][i], slopes[1][i], slopes[2][i]};
  return rows;
}

std::optional<Vec3> reference_force_n(Vec3 native_m, const std::array<double, 3>& torques_nm) {
  const auto rows = reference_rows(native_m);
  if (!rows) return std::nullopt;
  return torques_nm[0] * (*rows)[0] + torques_nm[1] * (*rows)[1] + torques_nm[2] * (*rows)[2];
}

}  // namespace touchtrial::device::falcon

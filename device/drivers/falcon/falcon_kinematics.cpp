#include "device/drivers/falcon/falcon_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial::device::falcon {
namespace {

/// Four counts a line, 320 lines a turn of the motor, 7.6 turns of the motor a turn of the arm.
constexpr double kDegPerCount = 360.0 / 9728.0;
constexpr double kDegAtCountZero = 32.9895;

/// Beyond the angles of all positions in reach within 60 mm of the centre (-50.2 to 105.5 degrees).
constexpr double kMinTheta1Rad = -90.0 * kRadPerDeg;
constexpr double kMaxTheta1Rad = 120.0 * kRadPerDeg;

/// Limit for the determinant of the three pulls, which have length 1: -0.58 at the centre, nowhere
/// nearer to zero than -0.11 within a cube of 80 mm. It is zero where the legs cannot hold the
/// hand, and positive beyond, where the legs would have to pass through one another.
constexpr double kMinDeterminant = -0.02;

Vec3 cross(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double determinant(const std::array<Vec3, 3>& rows) noexcept {
  return dot(rows[0], cross(rows[1], rows[2]));
}

/// The centre of the sphere on which a leg holds the hand.
Vec3 sphere_middle_m(double theta1_rad, const LegDirection& leg) noexcept {
  return to_native_axes(
      {kOffsetM + kArmM * std::cos(theta1_rad), 0.0, kArmM * std::sin(theta1_rad)}, leg);
}

/// \return where three spheres of the parallelogram's radius meet, on the person's side
std::optional<Vec3> meeting_point(const std::array<Vec3, 3>& middle_m) noexcept {
  const Vec3 a = middle_m[1] - middle_m[0];
  const Vec3 b = middle_m[2] - middle_m[0];
  const Vec3 normal = cross(a, b);  // away from the person, as the legs follow each other
  const double area_square = dot(normal, normal);
  if (!(area_square > 1e-16)) return std::nullopt;
  const Vec3 to_circle = (0.5 / area_square) * cross(dot(a, a) * b - dot(b, b) * a, normal);
  const double height_square = kParallelogramM * kParallelogramM - dot(to_circle, to_circle);
  if (!(height_square >= 0.0)) return std::nullopt;
  return middle_m[0] + to_circle - std::sqrt(height_square / area_square) * normal;
}

/// The configuration of the legs at a reachable position.
struct Stand {
  LegJacobian jacobian;
  bool upright = true;  ///< every parallelogram leads away from the base
};

Stand stand_at(Vec3 native_m, const PerLeg& theta1_rad) noexcept {
  Stand stand;
  for (std::size_t i = 0; i < 3; ++i) {
    const LegPoint grip = seen_by_leg(native_m, kLegDirections[i]);
    const double arm_across = kArmM * std::cos(theta1_rad[i]);
    const double arm_along = kArmM * std::sin(theta1_rad[i]);
    const Vec3 pull = (1.0 / kParallelogramM) *
                      Vec3{grip.across_m - arm_across, grip.side_m, grip.along_m - arm_along};
    stand.jacobian.pull[i] = to_native_axes(pull, kLegDirections[i]);
    stand.jacobian.lever_m[i] = arm_across * pull.z - arm_along * pull.x;
    stand.upright = stand.upright && pull.z > 0.0;
  }
  return stand;
}

/// \return whether the configuration is possible in a Falcon's housing
bool is_falcon(const Stand& stand) noexcept {
  const PerLeg& lever_m = stand.jacobian.lever_m;
  return stand.upright && lever_m[0] >= 0.0 && lever_m[1] >= 0.0 && lever_m[2] >= 0.0 &&
         determinant(stand.jacobian.pull) < 0.0;
}

bool are_possible(const PerLeg& theta1_rad) noexcept {
  return std::all_of(theta1_rad.begin(), theta1_rad.end(), [](double theta1) {
    return theta1 >= kMinTheta1Rad && theta1 <= kMaxTheta1Rad;
  });
}

}  // namespace

double theta1_of_count(std::int16_t count) noexcept {
  return (kDegPerCount * count + kDegAtCountZero) * kRadPerDeg;
}

PerLeg theta1_of_counts(const EncoderCounts& counts) noexcept {
  return {theta1_of_count(counts[0]), theta1_of_count(counts[1]), theta1_of_count(counts[2])};
}

std::optional<PerLeg> torques_nm(const LegJacobian& jacobian, Vec3 force_n) noexcept {
  const auto& pull = jacobian.pull;
  const double det = determinant(pull);
  if (!(det <= kMinDeterminant)) return std::nullopt;
  // The legs' forces along their pulls add up to the force on the hand.
  const PerLeg torques = {jacobian.lever_m[0] * dot(force_n, cross(pull[1], pull[2])) / det,
                          jacobian.lever_m[1] * dot(force_n, cross(pull[2], pull[0])) / det,
                          jacobian.lever_m[2] * dot(force_n, cross(pull[0], pull[1])) / det};
  if (!is_finite({torques[0], torques[1], torques[2]})) return std::nullopt;
  return torques;
}

Pose forward_kinematics(const PerLeg& theta1_rad) noexcept {
  if (!are_possible(theta1_rad)) return {};
  const auto position_m = meeting_point({sphere_middle_m(theta1_rad[0], kLegDirections[0]),
                                         sphere_middle_m(theta1_rad[1], kLegDirections[1]),
                                         sphere_middle_m(theta1_rad[2], kLegDirections[2])});
  if (!position_m) return {};
  const Stand stand = stand_at(*position_m, theta1_rad);
  if (!is_falcon(stand)) return {};
  const bool holds = determinant(stand.jacobian.pull) <= kMinDeterminant;
  return {holds ? PoseStatus::ok : PoseStatus::singular, *position_m, stand.jacobian};
}

}  // namespace touchtrial::device::falcon

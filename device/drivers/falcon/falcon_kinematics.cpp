#include "device/drivers/falcon/falcon_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial::device::falcon {
namespace {

/// Four counts per line, 320 lines per turn of the motor, 7.6 turns of the motor per turn of the
/// arm.
constexpr double kDegPerCount = 360.0 / 9728.0;
constexpr double kDegAtCountZero = 32.9895;

/// Wider than the range of angles within 60 mm of the centre (-50.2 to 105.5 degrees).
constexpr double kMinTheta1Rad = -90.0 * kRadPerDeg;
constexpr double kMaxTheta1Rad = 120.0 * kRadPerDeg;

/// Maximum of the determinant of the three pulls, which have length 1: -0.58 at the centre, at most
/// -0.11 within a cube of 80 mm. It is zero where the legs cannot support the hand, and positive
/// where the legs would have to pass through each other.
constexpr double kMinDeterminant = -0.02;

Vec3 cross(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double determinant(const std::array<Vec3, 3>& rows) noexcept {
  return dot(rows[0], cross(rows[1], rows[2]));
}

/// \return the centre of the sphere on which a leg's parallelogram lets the grip move
Vec3 sphere_centre_m(double theta1_rad, const LegDirection& leg) noexcept {
  return to_native_axes(
      {kOffsetM + kArmM * std::cos(theta1_rad), 0.0, kArmM * std::sin(theta1_rad)}, leg);
}

/// \return the intersection of three spheres with the parallelogram's length as radius, on the
///   person's side
std::optional<Vec3> sphere_intersection(const std::array<Vec3, 3>& centres_m) noexcept {
  const Vec3 a = centres_m[1] - centres_m[0];
  const Vec3 b = centres_m[2] - centres_m[0];
  const Vec3 normal = cross(a, b);  // points away from the person, because of the legs' order
  const double area_square = dot(normal, normal);
  if (!(area_square > 1e-16)) return std::nullopt;
  const Vec3 to_circle = (0.5 / area_square) * cross(dot(a, a) * b - dot(b, b) * a, normal);
  const double height_square = kParallelogramM * kParallelogramM - dot(to_circle, to_circle);
  if (!(height_square >= 0.0)) return std::nullopt;
  return centres_m[0] + to_circle - std::sqrt(height_square / area_square) * normal;
}

/// The configuration of the legs at a reachable position.
struct LegConfiguration {
  LegJacobian jacobian;
  bool is_upright = true;  ///< every parallelogram points away from the base
};

LegConfiguration configuration_at(Vec3 native_m, const PerLeg& theta1_rad) noexcept {
  LegConfiguration legs;
  for (std::size_t i = 0; i < 3; ++i) {
    const LegPoint grip = to_leg_frame(native_m, kLegDirections[i]);
    const double arm_across = kArmM * std::cos(theta1_rad[i]);
    const double arm_along = kArmM * std::sin(theta1_rad[i]);
    const Vec3 pull = (1.0 / kParallelogramM) *
                      Vec3{grip.across_m - arm_across, grip.side_m, grip.along_m - arm_along};
    legs.jacobian.pull[i] = to_native_axes(pull, kLegDirections[i]);
    legs.jacobian.lever_m[i] = arm_across * pull.z - arm_along * pull.x;
    legs.is_upright = legs.is_upright && pull.z > 0.0;
  }
  return legs;
}

/// \return whether a Falcon's housing allows the configuration
bool is_valid_configuration(const LegConfiguration& legs) noexcept {
  const PerLeg& lever_m = legs.jacobian.lever_m;
  return legs.is_upright && lever_m[0] >= 0.0 && lever_m[1] >= 0.0 && lever_m[2] >= 0.0 &&
         determinant(legs.jacobian.pull) < 0.0;
}

bool are_valid_angles(const PerLeg& theta1_rad) noexcept {
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
  if (!are_valid_angles(theta1_rad)) return {};
  const auto position_m = sphere_intersection({sphere_centre_m(theta1_rad[0], kLegDirections[0]),
                                               sphere_centre_m(theta1_rad[1], kLegDirections[1]),
                                               sphere_centre_m(theta1_rad[2], kLegDirections[2])});
  if (!position_m) return {};
  const LegConfiguration legs = configuration_at(*position_m, theta1_rad);
  if (!is_valid_configuration(legs)) return {};
  const bool is_regular = determinant(legs.jacobian.pull) <= kMinDeterminant;
  return {is_regular ? PoseStatus::ok : PoseStatus::singular, *position_m, legs.jacobian};
}

}  // namespace touchtrial::device::falcon

#include "device/falcon/falcon_kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial::device::falcon {
namespace {

constexpr double kDegPerCount = 0.0364347;
constexpr double kDegAtCountZero = 35.0;

/// A little beyond the angles of all positions in reach (-75.4 to 113.5 degrees).
constexpr double kLeastTheta1Rad = -90.0 * kRadPerDeg;
constexpr double kGreatestTheta1Rad = 120.0 * kRadPerDeg;

/// Limit for the determinant of the three pulls, which are about unit vectors: -0.80 at the centre,
/// nowhere nearer to zero than -0.24 within a cube of 80 mm. It is zero where the legs cannot hold
/// the hand, and positive beyond, where the legs would have to pass through one another.
constexpr double kLeastDeterminant = -0.02;

Vec3 cross(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double determinant(const std::array<Vec3, 3>& rows) noexcept {
  return dot(rows[0], cross(rows[1], rows[2]));
}

/// The arms' ends, in the legs' planes.
struct Arms {
  PerLeg across_m;
  PerLeg along_m;
};

Arms arms_at(const PerLeg& theta1_rad) noexcept {
  Arms arms{};
  for (std::size_t i = 0; i < 3; ++i) {
    arms.across_m[i] = kArmM * std::cos(theta1_rad[i]);
    arms.along_m[i] = kArmM * std::sin(theta1_rad[i]);
  }
  return arms;
}

/// How far the legs are from closing at a position, and which way that changes.
struct Closure {
  PerLeg gap_m{};
  std::array<Vec3, 3> pull;  ///< its gradient
  PerLeg lever_m{};
  bool exists = false;  ///< the parallelograms reach far enough to the side
  bool upright = true;  ///< every parallelogram leads away from the base
};

Closure closure_at(Vec3 native_m, const Arms& arms) noexcept {
  Closure c;
  for (std::size_t i = 0; i < 3; ++i) {
    const LegPoint p = seen_by_leg(native_m, kLegDirections[i]);
    const double upright_square = kParallelogramM * kParallelogramM - p.side_m * p.side_m;
    const double across = p.across_m - arms.across_m[i];
    const double along = p.along_m - arms.along_m[i];
    const double length = std::sqrt(across * across + along * along);
    if (!(upright_square > 1e-12) || !(length > 1e-6)) return c;
    const double upright = std::sqrt(upright_square);
    c.gap_m[i] = length - (2.0 * kEndLinkM + upright);
    c.pull[i] =
        to_native_axes({across / length, p.side_m / upright, along / length}, kLegDirections[i]);
    c.lever_m[i] = (arms.across_m[i] * along - arms.along_m[i] * across) / length;
    c.upright = c.upright && along > 0.0;
  }
  c.exists = true;
  return c;
}

double sum_of_squares(const PerLeg& gap_m) noexcept {
  return gap_m[0] * gap_m[0] + gap_m[1] * gap_m[1] + gap_m[2] * gap_m[2];
}

bool is_closed(const Closure& c) noexcept {
  constexpr double kTolerance = 1e-12;
  return std::abs(c.gap_m[0]) < kTolerance && std::abs(c.gap_m[1]) < kTolerance &&
         std::abs(c.gap_m[2]) < kTolerance;
}

/// \return the capped Newton step; nothing where the gradients do not span the space
std::optional<Vec3> newton_step(const Closure& c) noexcept {
  constexpr double kLongestM = 0.020;
  const double det = determinant(c.pull);
  if (!(std::abs(det) > 1e-9)) return std::nullopt;
  const Vec3 sum = c.gap_m[0] * cross(c.pull[1], c.pull[2]) +
                   c.gap_m[1] * cross(c.pull[2], c.pull[0]) +
                   c.gap_m[2] * cross(c.pull[0], c.pull[1]);
  const Vec3 step = (-1.0 / det) * sum;
  const double length = norm(step);
  if (!std::isfinite(length)) return std::nullopt;
  return length > kLongestM ? (kLongestM / length) * step : step;
}

/// Halves the step until the legs come nearer to closing.
/// \return whether they did
bool advance(Vec3& position_m, Closure& closure, Vec3 step, const Arms& arms) noexcept {
  constexpr int kMostHalvings = 10;
  const double before = sum_of_squares(closure.gap_m);
  for (int halving = 0; halving < kMostHalvings; ++halving, step = 0.5 * step) {
    const Closure next = closure_at(position_m + step, arms);
    if (!next.exists || !(sum_of_squares(next.gap_m) < before)) continue;
    position_m = position_m + step;
    closure = next;
    return true;
  }
  return false;
}

/// \return whether the legs stand as they do in a Falcon's housing
bool is_falcon(const Closure& c) noexcept {
  return c.upright && c.lever_m[0] >= 0.0 && c.lever_m[1] >= 0.0 && c.lever_m[2] >= 0.0 &&
         determinant(c.pull) < 0.0;
}

/// Newton's method from a start.
/// \return out of reach if it does not close the legs
Pose solve_from(Vec3 start_m, const Arms& arms) noexcept {
  constexpr int kMostSteps = 25;
  Pose pose;
  Vec3 position_m = start_m;
  Closure closure = closure_at(position_m, arms);
  if (!closure.exists) return pose;
  while (!is_closed(closure)) {
    if (pose.iterations == kMostSteps) return pose;
    ++pose.iterations;
    const std::optional<Vec3> step = newton_step(closure);
    if (!step || !advance(position_m, closure, *step, arms)) return pose;
  }
  if (!is_falcon(closure)) return pose;
  pose.native_m = position_m;
  pose.jacobian = {closure.pull, closure.lever_m};
  const bool holds = determinant(closure.pull) <= kLeastDeterminant;
  pose.status = holds ? PoseStatus::ok : PoseStatus::singular;
  return pose;
}

bool are_possible(const PerLeg& theta1_rad) noexcept {
  return std::all_of(theta1_rad.begin(), theta1_rad.end(), [](double theta1) {
    return theta1 >= kLeastTheta1Rad && theta1 <= kGreatestTheta1Rad;
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
  if (!(det <= kLeastDeterminant)) return std::nullopt;
  // The legs' forces along their pulls add up to the force on the hand.
  const PerLeg torques = {jacobian.lever_m[0] * dot(force_n, cross(pull[1], pull[2])) / det,
                          jacobian.lever_m[1] * dot(force_n, cross(pull[2], pull[0])) / det,
                          jacobian.lever_m[2] * dot(force_n, cross(pull[0], pull[1])) / det};
  if (!is_finite({torques[0], torques[1], torques[2]})) return std::nullopt;
  return torques;
}

Pose forward_kinematics(const PerLeg& theta1_rad, Vec3 start_m) noexcept {
  if (!are_possible(theta1_rad)) return {};
  const Arms arms = arms_at(theta1_rad);
  Pose pose = solve_from(start_m, arms);
  if (pose.status != PoseStatus::out_of_reach || start_m == kCentreM) return pose;
  const int wasted = pose.iterations;
  pose = solve_from(kCentreM, arms);
  pose.iterations += wasted;
  return pose;
}

}  // namespace touchtrial::device::falcon

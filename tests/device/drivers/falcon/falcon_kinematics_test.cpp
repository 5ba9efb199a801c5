#include "device/drivers/falcon/falcon_kinematics.hpp"

#include "core/random.hpp"
#include "device/drivers/falcon/emulator/falcon_legs.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace touchtrial::device::falcon {
namespace {

constexpr int kPoses = 5000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 random_vector(RandomStream& random, double most) {
  return {random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
}

/// \return a position in the sphere that the device promises
Vec3 random_position_m(RandomStream& random) {
  while (true) {
    const Vec3 device_mm = random_vector(random, kWorkspaceRadiusMm);
    if (norm(device_mm) <= kWorkspaceRadiusMm) return to_native_m(device_mm);
  }
}

PerLeg theta1_at(Vec3 native_m) {
  const auto theta1_rad = reference_theta1(native_m);
  REQUIRE(theta1_rad);
  return *theta1_rad;
}

LegJacobian jacobian_at(Vec3 native_m) {
  return forward_kinematics(theta1_at(native_m)).jacobian;
}

TEST_CASE("falcon frames: the device frame is the native one from the centre, in millimetres") {
  CHECK(to_device_mm(kCentreM) == Vec3{0.0, 0.0, 0.0});
  const Vec3 device_mm = to_device_mm({0.010, -0.020, 0.165});
  CHECK(device_mm.x == Approx(10.0));
  CHECK(device_mm.y == Approx(-20.0));
  CHECK(device_mm.z == Approx(10.0));
  const Vec3 there_and_back = to_device_mm(to_native_m({1.0, 2.0, 3.0}));
  CHECK(norm(there_and_back - Vec3{1.0, 2.0, 3.0}) < 1e-12);
}

TEST_CASE("falcon encoders: 32.9895 degrees at count 0, 9,728 counts a turn") {
  constexpr double kDeg = 3.14159265358979323846 / 180.0;
  CHECK(theta1_of_count(0) == Approx(32.9895 * kDeg));
  for (int count = -32768; count <= 32767; ++count) {
    const double expected = (32.9895 + 360.0 * count / 9728.0) * kDeg;
    const double found = theta1_of_count(static_cast<std::int16_t>(count));
    if (std::abs(found - expected) > 1e-12) FAIL("count " << count);
  }
}

TEST_CASE("falcon positions are those of the maker-side library, to a few micrometres") {
  // What Force Dimension's library 3.17.5 answers for these counts: z towards the person, which it
  // calls x, then x and y. Its zero angle has more digits than ours.
  struct Answer {
    EncoderCounts counts;
    Vec3 device_mm;
  };
  const std::vector<Answer> answers = {{{0, 0, 0}, {0.0, 0.0, 9.0804}},
                                       {{-900, -900, -900}, {0.0, 0.0, -29.7282}},
                                       {{900, 900, 900}, {0.0, 0.0, 42.6713}},
                                       {{100, 50, -200}, {-8.6411, -11.7987, 7.6244}},
                                       {{-300, 400, 120}, {-20.7295, 25.0946, 8.7451}},
                                       {{-500, -600, -450}, {6.0308, 0.3998, -14.0197}},
                                       {{200, -100, 300}, {19.4936, -0.3022, 13.6349}},
                                       {{350, 0, -350}, {-7.7044, -31.1932, 5.6084}}};
  for (const Answer& answer : answers) {
    const Pose pose = forward_kinematics(theta1_of_counts(answer.counts));
    INFO("counts " << answer.counts[0] << ' ' << answer.counts[1] << ' ' << answer.counts[2]);
    REQUIRE(pose.status == PoseStatus::ok);
    CHECK(norm(to_device_mm(pose.native_m) - answer.device_mm) < 0.003);
  }
}

TEST_CASE("falcon forward kinematics undoes the law of cosines to 1e-11 m") {
  RandomStream random(3, "falcon forward");
  double worst_m = 0.0;
  for (int i = 0; i < kPoses; ++i) {
    const Vec3 position = random_position_m(random);
    const Pose pose = forward_kinematics(theta1_at(position));
    REQUIRE(pose.status == PoseStatus::ok);
    worst_m = std::max(worst_m, norm(pose.native_m - position));
  }
  CHECK(worst_m < 1e-11);
}

TEST_CASE("falcon forward kinematics: angles out of reach give a status") {
  for (const double bad : {kNan, kInfinity, -kInfinity, 10.0, -10.0, 3.0}) {
    const Pose pose = forward_kinematics({bad, 0.5, 0.5});
    CHECK(pose.status == PoseStatus::out_of_reach);
    CHECK(pose.native_m == kCentreM);
  }
  const Pose torn = forward_kinematics({-1.5, 2.0, -1.5});
  CHECK(torn.status == PoseStatus::out_of_reach);
  CHECK(torn.native_m == kCentreM);
}

/// Checks that hold for all counts.
void check_sane(const Pose& pose, const PerLeg& theta1_rad) {
  REQUIRE(is_finite(pose.native_m));
  if (pose.status == PoseStatus::out_of_reach) {
    REQUIRE(pose.native_m == kCentreM);
    REQUIRE_FALSE(torques_nm(pose.jacobian, {1.0, 1.0, 1.0}));
    return;
  }
  // At the very edge of the reach rounding may put the position outside.
  if (const auto angles = reference_theta1(pose.native_m)) {
    REQUIRE(std::abs((*angles)[0] - theta1_rad[0]) < 1e-4);
  }
  const auto torques = torques_nm(pose.jacobian, {8.0, -8.0, 8.0});
  REQUIRE(torques.has_value() == (pose.status == PoseStatus::ok));
  if (torques) REQUIRE(is_finite({(*torques)[0], (*torques)[1], (*torques)[2]}));
}

TEST_CASE("falcon forward kinematics stays finite on hostile encoder counts") {
  RandomStream random(6, "falcon hostile");
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const double spread = i % 2 == 0 ? 32768.0 : 3500.0;
    EncoderCounts counts{};
    for (auto& count : counts) {
      count = static_cast<std::int16_t>(random.uniform(-spread, spread));
    }
    const PerLeg angles = theta1_of_counts(counts);
    const Pose pose = forward_kinematics(angles);
    check_sane(pose, angles);
    if (pose.status == PoseStatus::ok) ++found;
  }
  CHECK(found > 500);
  CHECK(found < 15000);
}

TEST_CASE("falcon Jacobian agrees with numerical differentiation") {
  RandomStream random(7, "falcon jacobian");
  for (int i = 0; i < kPoses; ++i) {
    const Vec3 position = random_position_m(random);
    const LegJacobian jacobian = jacobian_at(position);
    const auto rows = reference_rows(position);
    REQUIRE(rows);
    for (std::size_t leg = 0; leg < 3; ++leg) {
      const Vec3 row = (1.0 / jacobian.lever_m[leg]) * jacobian.pull[leg];
      REQUIRE(norm(row - (*rows)[leg]) < 1e-7 * norm(row));
    }
  }
}

TEST_CASE("falcon torques make the requested force, along z as along x and y") {
  RandomStream random(10, "falcon force");
  for (int i = 0; i < 500; ++i) {
    const Vec3 position = random_position_m(random);
    const Vec3 force_n = random_vector(random, 8.0);
    const PerLeg torques = torques_nm(jacobian_at(position), force_n).value();
    REQUIRE(norm(reference_force_n(position, torques).value() - force_n) < 1e-6);
  }
  // At the centre each motor carries a third of a force along the axis.
  const PerLeg torques = torques_nm(jacobian_at(kCentreM), {0.0, 0.0, 1.0}).value();
  CHECK(torques[0] == Approx(torques[1]));
  CHECK(torques[1] == Approx(torques[2]));
  CHECK(torques[0] > 0.0);
}

TEST_CASE("falcon torques: 8 N anywhere in the workspace stay within 0.8 N m") {
  RandomStream random(12, "falcon strength");
  double most_nm = 0.0;
  for (int i = 0; i < kPoses; ++i) {
    const Vec3 position = random_position_m(random);
    const Vec3 direction = random_vector(random, 1.0);
    const Vec3 force_n = (8.0 / norm(direction)) * direction;
    const PerLeg torques = torques_nm(jacobian_at(position), force_n).value();
    for (const double torque : torques) {
      most_nm = std::max(most_nm, std::abs(torque));
    }
  }
  CHECK(most_nm < 0.8);
  CHECK(most_nm > 0.6);
}

TEST_CASE("falcon forward kinematics: where the legs cannot hold the hand a pose is singular") {
  RandomStream random(13, "falcon singular");
  int found = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 position = kCentreM + random_vector(random, 0.12);
    const auto angles = reference_theta1(position);
    if (!angles) continue;
    const Pose pose = forward_kinematics(*angles);
    if (pose.status == PoseStatus::out_of_reach) continue;  // angles beyond the arms' range
    const auto& pull = pose.jacobian.pull;
    const double volume = dot(pull[0], {pull[1].y * pull[2].z - pull[1].z * pull[2].y,
                                        pull[1].z * pull[2].x - pull[1].x * pull[2].z,
                                        pull[1].x * pull[2].y - pull[1].y * pull[2].x});
    if (volume < -0.019 || volume > -0.002) continue;
    ++found;
    REQUIRE(pose.status == PoseStatus::singular);
    REQUIRE(norm(pose.native_m - position) < 1e-8);
    REQUIRE_FALSE(torques_nm(pose.jacobian, {0.0, 0.0, 1.0}));
  }
  CHECK(found > 20);
}

TEST_CASE(
    "falcon torques: a pose that cannot be held, or a number that is not finite, gives none") {
  LegJacobian flat = jacobian_at(kCentreM);
  CHECK(torques_nm(flat, {0.0, 0.0, 1.0}));
  CHECK_FALSE(torques_nm(flat, {kNan, 0.0, 0.0}));
  CHECK_FALSE(torques_nm(flat, {0.0, kInfinity, 0.0}));
  for (Vec3& pull : flat.pull) pull.z = 0.0;
  CHECK_FALSE(torques_nm(flat, {0.0, 0.0, 1.0}));
  CHECK_FALSE(torques_nm(LegJacobian{}, {0.0, 0.0, 1.0}));
  LegJacobian broken = jacobian_at(kCentreM);
  broken.lever_m[1] = kNan;
  CHECK_FALSE(torques_nm(broken, {0.0, 0.0, 1.0}));
}

}  // namespace
}  // namespace touchtrial::device::falcon

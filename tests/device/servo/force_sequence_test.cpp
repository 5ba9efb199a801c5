#include "device/servo/force_sequence.hpp"

#include "device/drivers/registry.hpp"
#include "device/flat_wall.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <array>

namespace touchtrial {
namespace {

/// Runs a sequence tick by tick and sends its forces unchanged.
std::vector<double> forces_of(device::ForceSequence& sequence, std::int64_t ticks) {
  std::vector<double> forces;
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    forces.push_back(sequence.force_n({}).z);
    sequence.record({{}, {0.0, 0.0, forces.back()}, tick});
  }
  return forces;
}

TEST_CASE(
    "a sequence of forces goes smoothly from one to the other and asks only the one that acts") {
  std::array<int, 2> asked{};
  const auto counted = [&asked](std::size_t which, double z_n) {
    return ForceBy([&asked, which, z_n](const device::DeviceSample&) {
      ++asked.at(which);
      return Vec3{0.0, 0.0, z_n};
    });
  };
  ForceBy first = counted(0, 1.0);
  ForceBy second = counted(1, 3.0);
  device::ForceSequence sequence(first, second, 100, 200);
  const std::vector<double> forces = forces_of(sequence, 400);
  CHECK(forces[99] == 1.0);
  CHECK(forces[100] == 1.0);
  CHECK(forces[200] == 2.0);
  CHECK(forces[300] == 3.0);
  double greatest_step = 0.0;
  for (std::size_t i = 1; i < forces.size(); ++i) {
    CHECK(forces[i] >= forces[i - 1]);
    greatest_step = std::max(greatest_step, forces[i] - forces[i - 1]);
  }
  CHECK(greatest_step < 1.51 * 2.0 / 200.0);
  CHECK(asked == std::array{300, 300});
}

TEST_CASE("a sequence of forces reports the hand's contact with each") {
  ConstantForce first({0.0, 0.0, 0.0});
  ConstantForce second({0.0, 0.0, 2.0});
  device::ForceSequence sequence(first, second, 30, 1);
  (void)forces_of(sequence, 50);
  CHECK(sequence.first().ticks == 30);
  CHECK(sequence.first().contact_ticks == 0);
  CHECK(sequence.second().ticks == 20);
  CHECK(sequence.second().contact_ticks == 19);
  CHECK(sequence.second().max_force_n == 2.0);
}

TEST_CASE("the change from one force to the other counts the ticks that an overrun left out") {
  ConstantForce first({0.0, 0.0, 1.0});
  ConstantForce second({0.0, 0.0, 3.0});
  device::ForceSequence sequence(first, second, 10, 10);
  sequence.record({{}, {}, 50});
  CHECK(sequence.force_n({}).z == 3.0);
}

TEST_CASE("a hand that rests on one plane of a sequence rests on the next") {
  const auto hand = device::open_device("simulated", {});
  FlatWall first;
  FlatWall second;
  device::ForceSequence sequence(first, second, 1000, 200);
  device::ServoOptions options{.limit_ticks = 2000};
  const device::ServoReport report =
      device::run_servo_in_virtual_time(*hand, sequence, sequence, options);
  CHECK(report.end == device::ServoEnd::time_limit);
  CHECK(report.limited_ticks < 100);
  CHECK(sequence.first().contact_ticks > 500);
  CHECK(sequence.second().contact_ticks > 1000);
}

}  // namespace
}  // namespace touchtrial

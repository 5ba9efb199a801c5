#include "device/drivers/simulated/simulated_hand.hpp"

#include "device/drivers/registry.hpp"
#include "device/flat_wall.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial {
namespace {

constexpr PlaneGeometry kPlane{0.2, 500, 500};

device::SimulatedHand hand_with(const device::HandOptions& options, std::uint64_t seed = 1) {
  RandomStream random(seed, "simulated_hand_test");
  return {options, device::ExplorationPath(kPlane, {.duration_s = options.explore_s}, random)};
}

std::vector<device::ServoSample> touch_flat_wall(device::SimulatedHand& hand) {
  FlatWall wall;
  KeptSamples kept;
  const device::ServoReport report = device::run_servo_in_virtual_time(hand, wall, kept, {});
  REQUIRE(report.end == device::ServoEnd::hand_stopped);
  return kept.samples;
}

std::size_t landing_of(const std::vector<device::ServoSample>& samples) {
  const auto landed = std::ranges::find_if(
      samples, [](const device::ServoSample& sample) { return sample.force_n.z > 0.0; });
  REQUIRE(landed != samples.end());
  return static_cast<std::size_t>(landed - samples.begin());
}

TEST_CASE(
    "a hand that pushes on a flat wall keeps contact, steady to 0.02 N, 0.5 s after landing") {
  device::HandOptions options{.push_n = GENERATE(0.3, 0.7, 1.3, 2.0), .explore_s = 3.0};
  device::SimulatedHand hand = hand_with(options);
  const std::vector<device::ServoSample> samples = touch_flat_wall(hand);
  const std::size_t settled = landing_of(samples) + 500;
  REQUIRE(settled + 1000 < samples.size());
  for (std::size_t i = settled; i < samples.size(); ++i) {
    REQUIRE(std::abs(samples[i].force_n.z - options.push_n) < 0.02);
  }
}

TEST_CASE("a hand lands from above, gently, within half a second") {
  device::HandOptions options{.start_height_mm = GENERATE(8.0, 20.0), .explore_s = 2.0};
  device::SimulatedHand hand = hand_with(options);
  const std::vector<device::ServoSample> samples = touch_flat_wall(hand);
  CHECK(samples.front().position_mm.z == options.start_height_mm);
  CHECK(landing_of(samples) < 500);
  for (const device::ServoSample& sample : samples)
    REQUIRE(sample.force_n.z < 2.0 * options.push_n);
}

TEST_CASE("a hand on a flat wall follows its path") {
  device::HandOptions options{.explore_s = 4.0};
  device::SimulatedHand hand = hand_with(options, 8);
  RandomStream random(8, "simulated_hand_test");
  const device::ExplorationPath path(kPlane, {.duration_s = options.explore_s}, random);
  std::size_t stroke = 0;
  const std::vector<device::ServoSample> samples = touch_flat_wall(hand);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec2 target_mm =
        path.at(static_cast<double>(i) * device::kServoTickS, stroke).position_mm;
    const Vec3 at_mm = samples[i].position_mm;
    REQUIRE(norm(Vec2{at_mm.x, at_mm.y} - target_mm) < 2.0);
  }
}

TEST_CASE("a hand that only bounces on a spring loses energy and never gains any") {
  device::HandOptions options{
      .arm_stiffness_n_per_mm = 0.0, .push_n = 0.0, .push_damping_n_s_per_mm = 0.0005};
  device::SimulatedHand hand = hand_with(options);
  constexpr double kStiffness = 0.4;
  const auto energy_mj = [&](const device::DeviceSample& s) {
    const double speed_m_s = s.velocity_mm_s.z / 1000.0;
    return 0.5 * options.mass_kg * speed_m_s * speed_m_s * 1000.0 +
           0.5 * kStiffness * s.position_mm.z * s.position_mm.z;
  };
  device::DeviceSample sample;
  REQUIRE(hand.read(sample) == device::DeviceStatus::ok);
  const double at_start = energy_mj(sample);
  double highest_late = 0.0;
  for (int tick = 0; tick < 4000; ++tick) {
    REQUIRE(hand.write({0.0, 0.0, -kStiffness * sample.position_mm.z}) == device::DeviceStatus::ok);
    REQUIRE(hand.read(sample) == device::DeviceStatus::ok);
    // The symplectic step makes the energy swing by omega * dt / 2, 3 %, about its mean.
    REQUIRE(energy_mj(sample) < 1.05 * at_start);
    if (tick > 2000) highest_late = std::max(highest_late, energy_mj(sample));
  }
  CHECK(highest_late < 0.01 * at_start);
}

TEST_CASE("forces move a hand as far as its arm's spring lets them") {
  device::HandOptions options{.explore_s = 3.0};
  device::SimulatedHand pushed = hand_with(options);
  device::SimulatedHand free = hand_with(options);
  for (int tick = 0; tick < 2500; ++tick) {
    REQUIRE(pushed.write({0.5, 0.0, 0.0}) == device::DeviceStatus::ok);
    REQUIRE(free.write({}) == device::DeviceStatus::ok);
  }
  device::DeviceSample at;
  device::DeviceSample otherwise;
  REQUIRE(pushed.read(at) == device::DeviceStatus::ok);
  REQUIRE(free.read(otherwise) == device::DeviceStatus::ok);
  const double deflection_mm = at.position_mm.x - otherwise.position_mm.x;
  CHECK(deflection_mm == Approx(0.5 / options.arm_stiffness_n_per_mm).epsilon(1e-6));
}

TEST_CASE("a hand's virtual clock counts ticks, and the hand stops at its time") {
  device::HandOptions options{.explore_s = 0.25};
  device::SimulatedHand hand = hand_with(options);
  CHECK(hand.now() == std::chrono::nanoseconds{0});
  CHECK(touch_flat_wall(hand).size() == 250);
  CHECK(hand.info().name == "simulated");
  CHECK(hand.info().simulated);
}

TEST_CASE(
    "a hand holds the device that it is given: heavier, stiffer to move, read in whole steps") {
  device::DeviceModel device;
  device.mass_kg = 0.3;
  device.coulomb_n = 0.1;
  device.position_step_mm = 0.05;
  device.max_force_n = 2.0;
  device::HandOptions options{.explore_s = 3.0};
  RandomStream random(1, "simulated_hand_test");
  const device::ExplorationPath path(kPlane, {.duration_s = options.explore_s}, random);
  device::SimulatedHand pushed(options, path, device);
  device::SimulatedHand free(options, path, device);
  CHECK(pushed.info().max_force_n == 2.0);
  device::DeviceSample at;
  device::DeviceSample otherwise;
  double max_mm = 0.0;
  for (int tick = 0; tick < 2500; ++tick) {
    // The device delivers 2 N of these 4 N, on a spring of 0.2 N/mm with friction of 0.1 N.
    REQUIRE(pushed.write({4.0, 0.0, 0.0}) == device::DeviceStatus::ok);
    REQUIRE(free.write({}) == device::DeviceStatus::ok);
    REQUIRE(pushed.read(at) == device::DeviceStatus::ok);
    REQUIRE(free.read(otherwise) == device::DeviceStatus::ok);
    REQUIRE(std::abs(at.position_mm.x / 0.05 - std::round(at.position_mm.x / 0.05)) < 1e-9);
    if (tick > 2000) {
      max_mm = std::max(max_mm, at.position_mm.x - otherwise.position_mm.x);
    }
  }
  CHECK(max_mm > 2.0 / 0.2 - 2.0 * 0.1 / 0.2 - 0.05);
  CHECK(max_mm < 2.0 / 0.2 + 2.0 * 0.1 / 0.2 + 0.05);
}

TEST_CASE("a hand refuses impossible options") {
  device::HandOptions weightless{.mass_kg = 0.0};
  CHECK_THROWS_AS(hand_with(weightless), std::invalid_argument);
  device::HandOptions pulling{.push_n = -0.1};
  CHECK_THROWS_AS(hand_with(pulling), std::invalid_argument);
  device::DeviceModel impossible;
  impossible.coulomb_n = -1.0;
  RandomStream random(1, "simulated_hand_test");
  CHECK_THROWS_AS(
      device::SimulatedHand({}, device::ExplorationPath(kPlane, {}, random), impossible),
      std::invalid_argument);
}

TEST_CASE("the simulated device is always present, and still strokes after a minute") {
  CHECK(device::device_driver("simulated").list({}).at(0).present);
  const std::unique_ptr<device::HapticDevice> device = device::open_device("simulated", {});
  CHECK(device->info().simulated);
  CHECK_FALSE(device->info().workspace.has_value());
  FlatWall wall;
  KeptSamples kept;
  const device::ServoReport report = device::run_servo_in_virtual_time(*device, wall, kept, {});
  CHECK(report.end == device::ServoEnd::time_limit);
  CHECK(report.contact_ticks > 50'000);
  for (const device::ServoSample& sample : kept.samples) {
    REQUIRE(sample.position_mm.x > 0.0);
    REQUIRE(sample.position_mm.x < 100.0);
  }
}

}  // namespace

}  // namespace touchtrial

#include "device/drivers/replay/replay_device.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/drivers/registry.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/flat_wall.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <stdexcept>

namespace touchtrial {
namespace {

/// A wall with a damper, so that the force depends on velocity too.
ForceBy damped_wall() {
  return ForceBy([](const device::DeviceSample& sample) -> Vec3 {
    if (sample.position_mm.z >= 0.0) return {};
    const Vec3& v = sample.velocity_mm_s;
    return {-0.001 * v.x, -0.001 * v.y, -0.4 * sample.position_mm.z - 0.0005 * v.z};
  });
}

std::vector<device::ServoSample> stroke_damped_wall() {
  RandomStream random(3, "replay_device_test");
  const device::HandOptions options{.explore_s = 4.0};
  device::SimulatedHand hand(options,
                             device::ExplorationPath({0.2, 500, 500}, {.duration_s = 4.0}, random));
  ForceBy wall = damped_wall();
  KeptSamples kept;
  REQUIRE(device::run_servo_in_virtual_time(hand, wall, kept, {}).end ==
          device::ServoEnd::hand_stopped);
  return kept.samples;
}

TEST_CASE("a recorded session replayed through the servo gives the same forces") {
  const std::vector<device::ServoSample> original = stroke_damped_wall();
  std::vector<Vec3> positions_mm;
  for (const device::ServoSample& sample : original) positions_mm.push_back(sample.position_mm);
  device::ReplayDevice replay({positions_mm, device::kServoRateHz});
  ForceBy wall = damped_wall();
  KeptSamples kept;
  const device::ServoReport report = device::run_servo_in_virtual_time(replay, wall, kept, {});
  CHECK(report.end == device::ServoEnd::hand_stopped);
  CHECK(report.contact_ticks > 3000);
  REQUIRE(kept.samples.size() == original.size());
  for (std::size_t i = 0; i < original.size(); ++i) {
    REQUIRE(kept.samples[i].position_mm == original[i].position_mm);
    REQUIRE(norm(kept.samples[i].force_n - original[i].force_n) < 1e-9);
  }
}

TEST_CASE("a replay goes through its positions once, with the velocity of each step") {
  device::ReplayDevice replay({{{0, 0, 1}, {2, 0, 1}, {2, -3, 1}}, 2000.0});
  CHECK(replay.info().max_rate_hz == 2000.0);
  CHECK(replay.info().simulated);
  std::vector<Vec3> velocities;
  device::DeviceSample sample;
  while (replay.read(sample) == device::DeviceStatus::ok) {
    velocities.push_back(sample.velocity_mm_s);
    CHECK(sample.sequence == velocities.size());
    CHECK(replay.write({1.0, 0.0, 0.0}) == device::DeviceStatus::ok);
  }
  CHECK(velocities == std::vector<Vec3>{{0, 0, 0}, {4000, 0, 0}, {0, -6000, 0}});
  CHECK(sample.position_mm == Vec3{2, -3, 1});
}

TEST_CASE("a motion without positions or without a rate is refused") {
  CHECK_THROWS_AS(device::RecordedMotion({}, 1000.0), std::invalid_argument);
  CHECK_THROWS_AS(device::RecordedMotion({{}}, 0.0), std::invalid_argument);
}

TEST_CASE("replay without a recording says which setting names one") {
  const std::vector<device::DeviceListing> listings = device::device_driver("replay").list({});
  REQUIRE(listings.size() == 1);
  CHECK_FALSE(listings[0].present);
  REQUIRE(listings[0].missing.size() == 1);
  CHECK_THAT(listings[0].missing[0], holds_text("replay.trace"));
  CHECK_THROWS_AS(device::open_device("replay", {}), DeviceError);
}

TEST_CASE("replay is opened through the registry with the recording of the settings") {
  const TempFolder folder;
  const auto file = folder.path() / "motion.csv";
  replace_file(file, "time_s,x_mm,y_mm,z_mm\n0,1,2,3\n0.001,1,2,3\n");
  device::DeviceSettings settings;
  settings.replay.trace = file;
  CHECK(device::device_driver("replay").list(settings).at(0).present);
  const std::unique_ptr<device::HapticDevice> device = device::open_device("replay", settings);
  std::filesystem::remove(file);
  device::DeviceSample sample;
  CHECK(device->read(sample) == device::DeviceStatus::ok);
  CHECK(sample.position_mm == Vec3{1, 2, 3});
}

}  // namespace

}  // namespace touchtrial

#include "device/servo/servo.hpp"

#include "device/flat_wall.hpp"
#include "device/passing_device.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

using namespace device;

TEST_CASE("the servo runs until the hand stops and records each position with its force") {
  ScriptedDevice device;
  device.ticks = 5;
  ConstantForce force({0.0, 0.0, 0.5});
  KeptSamples kept;
  const ServoReport report = device::run_servo_in_virtual_time(device, force, kept, {});
  CHECK(report.end == ServoEnd::hand_stopped);
  CHECK(report.ticks == 5);
  REQUIRE(kept.samples.size() == 5);
  CHECK(kept.samples[3].position_mm == Vec3{3.0, 0.0, -1.0});
  CHECK(kept.samples[3].force_n == device.written[3]);
}

TEST_CASE("when time is up the force fades to zero, and the last write is zero") {
  ScriptedDevice device;
  ConstantForce force({0.0, 0.0, 1.0});
  KeptSamples kept;
  const ServoReport report = device::run_servo_in_virtual_time(
      device, force, kept, {.limit_ticks = 3, .fade_ticks = 4, .limits = norm_limit_alone()});
  CHECK(report.end == ServoEnd::time_limit);
  CHECK(report.ticks == 7);
  const std::vector<Vec3> expected = {{0, 0, 1},   {0, 0, 1},    {0, 0, 1}, {0, 0, 0.75},
                                      {0, 0, 0.5}, {0, 0, 0.25}, {0, 0, 0}, {0, 0, 0}};
  CHECK(device.written == expected);
}

TEST_CASE("the smaller of the device's and the study's force limits holds") {
  ScriptedDevice device;
  device.ticks = 2;
  device.max_force_n = GENERATE(1.0, 9.0);
  const double limit_n = std::min(device.max_force_n, 2.0);
  ConstantForce force({0.0, 3.0, 0.0});
  KeptSamples kept;
  const ServoReport report =
      device::run_servo_in_virtual_time(device, force, kept, {.limits = norm_limit_alone(2.0)});
  CHECK(report.limited_ticks == 2);
  CHECK(report.force_limit_n == limit_n);
  CHECK(device.written[0] == Vec3{0.0, limit_n, 0.0});
}

TEST_CASE("a share of the force that changes while the servo runs is followed without a step") {
  ScriptedDevice device;
  ConstantForce force({0.0, 0.0, 1.0});
  KeptSamples kept;
  LatestValue<ServoParameters> parameters({0.5});
  ForceBy asks([&parameters, tick = 0](const DeviceSample&) mutable {
    if (++tick == 10) parameters.set({.force_share = 7.0});
    return Vec3{0.0, 0.0, 1.0};
  });
  VirtualClock clock;
  const ServoReport report = device::run_servo(
      device, asks, kept, {.limit_ticks = 200, .fade_ticks = 0, .limits = norm_limit_alone()},
      clock, {.parameters = &parameters});
  REQUIRE(report.ticks == 200);
  CHECK(kept.samples.front().force_n.z == 0.5);
  CHECK(kept.samples[9].force_n.z < 0.52);
  CHECK(kept.samples.back().force_n.z == 1.0);
  for (std::size_t i = 1; i < kept.samples.size(); ++i) {
    REQUIRE(kept.samples[i].force_n.z - kept.samples[i - 1].force_n.z <= 0.0100001);
  }
}

TEST_CASE("a share of the force that is not a number counts as zero") {
  ScriptedDevice device;
  ConstantForce force({0.0, 0.0, 0.4});
  KeptSamples kept;
  LatestValue<ServoParameters> parameters({std::numeric_limits<double>::quiet_NaN()});
  VirtualClock clock;
  const ServoReport report = device::run_servo(
      device, force, kept, {.limit_ticks = 5, .fade_ticks = 0}, clock, {.parameters = &parameters});
  CHECK(report.fault == SafetyFault::none);
  CHECK(kept.samples.back().force_n == Vec3{});
}

TEST_CASE("motors that one run has warmed are warm in the next") {
  MotorHeat heat;
  ConstantForce force({0.0, 0.0, 3.0});
  SafetyLimits limits = norm_limit_alone(3.3);
  limits.continuous_force_n = 0.88;
  limits.thermal_budget_s = 2.0;
  limits.max_slew_n_per_s = 1e6;
  VirtualClock clock;
  const auto last_force_n = [&] {
    ScriptedDevice device;
    KeptSamples kept;
    const ServoReport report = device::run_servo(
        device, force, kept, {.limit_ticks = 1900, .fade_ticks = 0, .limits = limits}, clock,
        {.heat = &heat});
    REQUIRE(report.ticks == 1900);
    return kept.samples.back().force_n.z;
  };
  CHECK(last_force_n() == 3.0);
  CHECK(heat.heat_n2 > 0.0);
  CHECK(last_force_n() < 2.0);
  clock.wait_until(clock.now() + std::chrono::hours(1));
  CHECK(last_force_n() == 3.0);
}

/// Says that it exerts four fifths of the force that it was given in the tick before.
class WeakDevice final : public PassingDevice {
 public:
  using PassingDevice::PassingDevice;
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override {
    const DeviceStatus status = PassingDevice::read(sample);
    sample.delivered_n = 0.8 * written_n_;
    return status;
  }
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override {
    written_n_ = force_n;
    return PassingDevice::write(force_n);
  }

 private:
  Vec3 written_n_;
};

TEST_CASE("a run reports the share of the forces that the device says it exerted") {
  RestingDevice resting;
  WeakDevice weak(resting);
  ConstantForce force({0.1, 0.0, 0.4});
  KeptSamples kept;
  const ServoOptions options{.limit_ticks = 500};
  CHECK(device::run_servo_in_virtual_time(weak, force, kept, options).delivered_share ==
        Approx(0.8));
  ScriptedDevice silent;
  CHECK(device::run_servo_in_virtual_time(silent, force, kept, options).delivered_share == 0.0);
}

TEST_CASE("a device's support is sent with every force, fades with it, and is no contact") {
  ScriptedDevice device;
  device.support_n = {0.0, 0.0, 1.0};
  ConstantForce force({0.5, 0.0, 0.0});
  KeptSamples kept;
  LatestValue<ServoParameters> parameters({0.0});  // strength off: still carried
  VirtualClock clock;
  const ServoReport report = device::run_servo(
      device, force, kept, {.limit_ticks = 3, .fade_ticks = 4, .limits = norm_limit_alone()}, clock,
      {.parameters = &parameters});
  CHECK(report.end == ServoEnd::time_limit);
  CHECK(report.contact_ticks == 0);
  CHECK(report.limited_ticks == 0);
  CHECK(report.force_limit_n == 3.3);  // all of it is left for the texture
  const std::vector<Vec3> expected = {{0, 0, 1},   {0, 0, 1},    {0, 0, 1}, {0, 0, 0.75},
                                      {0, 0, 0.5}, {0, 0, 0.25}, {0, 0, 0}, {0, 0, 0}};
  CHECK(device.written == expected);
  for (const ServoSample& sample : kept.samples) CHECK(sample.force_n == Vec3{});
}

TEST_CASE("a device with encoders that rests to the last bit under a newton ends the run, halted") {
  RestingDevice device;
  const double force_n = GENERATE(0.9, 1.1);
  device.has_encoders = GENERATE(false, true);
  ConstantForce force({0.0, 0.0, force_n});
  KeptSamples kept;
  const ServoReport report = device::run_servo_in_virtual_time(
      device, force, kept, {.limit_ticks = 2000, .limits = norm_limit_alone()});
  const bool freezes = device.has_encoders && force_n > 1.0;
  CHECK(report.end == (freezes ? ServoEnd::fault : ServoEnd::time_limit));
  CHECK(report.fault == (freezes ? SafetyFault::frozen_encoders : SafetyFault::none));
  CHECK(device.halts == (freezes ? 1 : 0));
  if (freezes) CHECK(report.ticks == 300);
}

TEST_CASE("a lost device ends the loop with a fault") {
  ScriptedDevice device;
  ConstantForce force({});
  KeptSamples kept;
  SECTION("while reading") {
    device.ticks = 4;
    device.end = DeviceStatus::fault;
    CHECK(device::run_servo_in_virtual_time(device, force, kept, {}).end == ServoEnd::fault);
    CHECK(kept.samples.size() == 4);
  }
  SECTION("while writing: the tick is not recorded") {
    device.fails_at_write = 3;
    CHECK(device::run_servo_in_virtual_time(device, force, kept, {}).end == ServoEnd::fault);
    CHECK(kept.samples.size() == 2);
  }
}

}  // namespace
}  // namespace touchtrial

// The plane in the device frame (x right, y up, z towards the person), whichever way it stands.
#include "device/servo/placed_device.hpp"

#include "device/drivers/falcon/falcon_device.hpp"
#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

constexpr Vec3 kRight{1.0, 0.0, 0.0}, kUp{0.0, 1.0, 0.0}, kTowardsPerson{0.0, 0.0, 1.0};
constexpr Vec3 kDown{0.0, -1.0, 0.0};

/// Which way the plane's axes point.
struct Axes {
  device::PlaneOrientation orientation;
  Vec3 x, y, z;
};
constexpr Axes kTable{device::PlaneOrientation::horizontal, kRight, kTowardsPerson, kUp};
constexpr Axes kWall{device::PlaneOrientation::vertical, kRight, kDown, kTowardsPerson};

TEST_CASE("a table's normal points up and a wall's to the person, and back again") {
  for (const Axes& axes : {kTable, kWall}) {
    CHECK(device::to_device_direction({1.0, 0.0, 0.0}, axes.orientation) == axes.x);
    CHECK(device::to_device_direction({0.0, 1.0, 0.0}, axes.orientation) == axes.y);
    CHECK(device::to_device_direction({0.0, 0.0, 1.0}, axes.orientation) == axes.z);
    const Vec3 any{0.3, -0.4, 1.2};
    CHECK(device::to_plane_direction(device::to_device_direction(any, axes.orientation),
                                     axes.orientation) == any);
  }
}

TEST_CASE("a plane's positions count from its top-left corner") {
  for (const Axes& axes : {kTable, kWall}) {
    RestingDevice resting;
    device::DeviceSample sample;
    REQUIRE(resting.read(sample) == device::DeviceStatus::ok);
    const Vec3 away_mm = 7.0 * axes.x + 11.0 * axes.y + -2.0 * axes.z;
    device::PlacedDevice placed(resting, {axes.orientation, sample.position_mm - away_mm});
    REQUIRE(placed.read(sample) == device::DeviceStatus::ok);
    CHECK(norm(sample.position_mm - Vec3{7.0, 11.0, -2.0}) < 1e-12);
  }
}

TEST_CASE("a device's support is asked for in its own frame and turned into the plane's") {
  for (const Axes& axes : {kTable, kWall}) {
    ScriptedDevice device;
    device.support_n = 0.7 * kUp;
    device::PlacedDevice placed(device, {axes.orientation, {3.0, 5.0, -7.0}});
    device::DeviceSample sample;
    REQUIRE(placed.read(sample) == device::DeviceStatus::ok);
    const Vec3 plane_n = placed.support_force_n(sample);
    CHECK(norm(plane_n.x * axes.x + plane_n.y * axes.y + plane_n.z * axes.z - 0.7 * kUp) < 1e-12);
    CHECK(norm(device.supported_mm - Vec3{0.0, 0.0, -1.0}) < 1e-12);
  }
}

TEST_CASE("a plane's force pushes the hand on a Falcon out of the plane, however it stands") {
  for (const Axes& axes : {kTable, kWall}) {
    device::falcon::FalconEmulator emulator({.firmware_runs = true, .homed = true});
    device::falcon::Lockstep lockstep;
    device::falcon::FalconOptions options{
        .pace = lockstep.pace(), .scheduling = {device::SchedulingPolicy::other, 0, false}};
    device::falcon::FalconDevice device(
        std::make_unique<device::falcon::EmulatorTransport>(emulator), {}, std::move(options));
    device::PlacedDevice placed(device, {axes.orientation, {-20.0, 0.0, 0.0}});
    lockstep.steps(2);
    REQUIRE(placed.write({0.2, -0.3, 1.5}) == device::DeviceStatus::ok);
    lockstep.step();
    // As the emulated motors, which share no code with the driver, push the hand.
    CHECK(norm(emulator.force_n() - (0.2 * axes.x + -0.3 * axes.y + 1.5 * axes.z)) < 0.02);

    // The hand goes 100 mm/s along the plane's y and 50 mm/s into it.
    emulator.set_hand([&axes, tick = 0](Vec3) mutable {
      ++tick;
      return 0.1 * tick * axes.y + -0.05 * tick * axes.z;
    });
    lockstep.steps(60);
    device::DeviceSample sample;
    REQUIRE(placed.read(sample) == device::DeviceStatus::ok);
    CHECK(norm(sample.position_mm - Vec3{20.0, 6.0, -3.0}) < 0.1);
    CHECK(norm(sample.velocity_mm_s - Vec3{0.0, 100.0, -50.0}) < 15.0);
  }
}

}  // namespace
}  // namespace touchtrial

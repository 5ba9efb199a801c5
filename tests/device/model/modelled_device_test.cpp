// A modelled device behind the driver's interface, under the servo and its safety chain.
#include "device/flat_wall.hpp"
#include "device/model/device_model.hpp"
#include "support/catch.hpp"

#include <string>

namespace touchtrial {
namespace {

using device::ModelledDevice;

/// A person who holds the handle at a place in the wall's frame, and presses.
device::DeviceDynamics::TipLoad held(Vec3 position_mm, Vec3 place_mm, double push_n) {
  return {0.2 * (place_mm - position_mm) + Vec3{0.0, 0.0, -push_n}, 0.1, {0.008, 0.008, 0.008}};
}

device::ServoReport press_on_wall(ModelledDevice& device, KeptSamples& kept,
                                  std::int64_t ticks = 3000) {
  device.place({0.0, 0.0, 1.0});
  device.set_hand([](double, Vec3 position_mm, Vec3) { return held(position_mm, {}, 0.5); });
  FlatWall wall;
  return device::run_servo_in_virtual_time(device, wall, kept, {.limit_ticks = ticks});
}

TEST_CASE("a person presses on a wall of every shipped device, and it holds against the push") {
  for (const device::DeviceModel& model : device::shipped_device_models()) {
    INFO(model.name);
    ModelledDevice device(model);
    KeptSamples kept;
    const device::ServoReport report = press_on_wall(device, kept);
    CHECK(report.end == device::ServoEnd::time_limit);
    REQUIRE(kept.samples.size() >= 3000);
    // Friction takes a part of the push; so does the arm, which pulls towards 0.
    const double depth_mm = -device.dynamics().true_position_mm().z;
    CHECK(depth_mm > 0.0);
    CHECK(kept.samples[2900].force_n.z <= 0.5 + model.coulomb_n);
    CHECK(kept.samples[2900].force_n.z >= 0.2 * 0.5 - model.coulomb_n);
  }
}

TEST_CASE("a modelled device reports its model's parameters") {
  const ModelledDevice touch(device::device_model("touch"));
  CHECK(touch.info().name == "modelled");
  CHECK(touch.info().model == "touch");
  CHECK(touch.info().simulated);
  CHECK(touch.info().max_force_n == 3.3);
  CHECK(touch.info().continuous_force_n == 0.88);
  CHECK(touch.info().max_stiffness_n_per_mm == 0.4);
  REQUIRE(touch.info().workspace);
  CHECK(touch.info().workspace->max_mm == Vec3{80.0, 60.0, 35.0});
  const ModelledDevice ideal(device::device_model("ideal"));
  CHECK(ideal.info().max_force_n == device::SafetyLimits{}.max_force_n);
  CHECK_FALSE(ideal.info().workspace);
}

TEST_CASE("every write is one tick of a millisecond, and every reading is new") {
  ModelledDevice device(device::device_model("falcon"));
  device::DeviceSample first;
  device::DeviceSample second;
  REQUIRE(device.read(first) == device::DeviceStatus::ok);
  CHECK(device.now() == std::chrono::nanoseconds(0));
  REQUIRE(device.write({}) == device::DeviceStatus::ok);
  REQUIRE(device.read(second) == device::DeviceStatus::ok);
  CHECK(second.sequence == first.sequence + 1);
  CHECK(device.now() == std::chrono::milliseconds(1));
}

TEST_CASE("a hand gets the time and the true state of the tip") {
  device::DeviceModel model = device::device_model("touch");
  ModelledDevice device(model);
  device.place({1.0, 2.0, 3.0});
  double last_s = -1.0;
  device.set_hand([&](double time_s, Vec3 position_mm, Vec3 velocity_mm_s) {
    last_s = time_s;
    CHECK(position_mm == device.dynamics().true_position_mm());
    CHECK(velocity_mm_s == device.dynamics().true_velocity_mm_s());
    return device::DeviceDynamics::TipLoad{{1.0, 0.0, 0.0}, 0.1};
  });
  for (int i = 0; i < 20; ++i) REQUIRE(device.write({}) == device::DeviceStatus::ok);
  CHECK(last_s == Approx(0.019));
  CHECK(device.dynamics().true_position_mm().x > 1.0);
}

TEST_CASE("after halt no force acts until a person re-arms") {
  device::DeviceModel model;
  model.name = "plain";
  model.mass_kg = 0.1;
  ModelledDevice device(model);
  REQUIRE(device.write({0.5, 0.0, 0.0}) == device::DeviceStatus::ok);
  CHECK(device.dynamics().delivered_force_n() == Vec3{0.5, 0.0, 0.0});
  device.halt();
  REQUIRE(device.write({0.5, 0.0, 0.0}) == device::DeviceStatus::ok);
  CHECK(device.dynamics().delivered_force_n() == Vec3{});
  device.rearm();
  REQUIRE(device.write({0.5, 0.0, 0.0}) == device::DeviceStatus::ok);
  CHECK(device.dynamics().delivered_force_n() == Vec3{0.5, 0.0, 0.0});
}

TEST_CASE("a handle that is pushed out of the workspace stops there") {
  const std::string name = GENERATE("falcon", "touch", "inverse3");
  device::DeviceModel model = device::device_model(name);
  model.workspace->min_mm.z = -20.0;  // nearer than the others
  ModelledDevice device(model);
  const Vec3 push_n = GENERATE(Vec3{2.5, 0.0, 0.0}, Vec3{0.0, 0.0, -2.5}, Vec3{1.5, -1.5, 1.5});
  for (int i = 0; i < 5000; ++i) REQUIRE(device.write(push_n) == device::DeviceStatus::ok);
  const device::Workspace& reach = *model.workspace;
  const Vec3 there_mm = device.dynamics().true_position_mm();
  constexpr double kGivesMm = 1.0;  // 2.6 N on 5 N/mm, and what the structure bends
  CHECK(there_mm.x <= reach.max_mm.x + kGivesMm);
  CHECK(there_mm.y >= reach.min_mm.y - kGivesMm);
  CHECK(there_mm.z >= reach.min_mm.z - kGivesMm);
  CHECK(there_mm.z <= reach.max_mm.z + kGivesMm);
  CHECK(norm(device.dynamics().true_velocity_mm_s()) < 1.0);
  const Vec3 middle_mm = 0.5 * (reach.min_mm + reach.max_mm);
  CHECK(norm(there_mm - middle_mm) > 15.0);
}

TEST_CASE("a device that falls silent is a stale one to the safety chain") {
  device::DeviceModel model = device::device_model("falcon");
  model.planted_faults.silent_after_s = 1.0;
  ModelledDevice device(model);
  KeptSamples kept;
  const device::ServoReport report = press_on_wall(device, kept);
  CHECK(report.end == device::ServoEnd::fault);
  CHECK(report.fault == device::SafetyFault::stale_sample);
  CHECK(report.ticks >= 1000);
  CHECK(report.ticks <= 1012);
}

TEST_CASE("a device whose link is lost says so") {
  device::DeviceModel model = device::device_model("touch");
  model.planted_faults.lost_after_s = 0.5;
  ModelledDevice device(model);
  KeptSamples kept;
  const device::ServoReport report = press_on_wall(device, kept);
  CHECK(report.end == device::ServoEnd::fault);
  CHECK(report.device_fault == device::DeviceFault::link_lost);
  CHECK(report.ticks <= 501);
  CHECK(device.dynamics().delivered_force_n().z <= 0.5);
}

}  // namespace
}  // namespace touchtrial

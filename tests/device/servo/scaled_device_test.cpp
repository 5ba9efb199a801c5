#include "device/servo/scaled_device.hpp"

#include "device/drivers/registry.hpp"
#include "device/flat_wall.hpp"
#include "device/safety/safety_limits.hpp"
#include "device/servo/servo.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <memory>

namespace touchtrial {
namespace {

using namespace device;

constexpr DeviceScale kScale{{2.0, 0.5, 1.25}, {0.8, 1.0, 1.6}};

DeviceInfo full_info() {
  DeviceInfo info{"lab", "7", 4.0};
  info.continuous_force_n = 1.0;
  info.max_stiffness_n_per_mm = 0.8;
  info.max_damping_n_s_per_mm = 0.004;
  info.workspace = Workspace{{-40.0, -30.0, -20.0}, {40.0, 30.0, 20.0}};
  return info;
}

/// Keeps what it is told, and stands where it is put.
class Recorder final : public HapticDevice {
 public:
  [[nodiscard]] DeviceInfo info() const override { return full_info(); }
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override {
    sample = at;
    return DeviceStatus::ok;
  }
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override {
    told_n = force_n;
    max_n = std::max(max_n, norm(force_n));
    return DeviceStatus::ok;
  }
  [[nodiscard]] Vec3 support_force_n(const DeviceSample& sample) noexcept override {
    asked_mm = sample.position_mm;
    return {0.0, 0.7, 0.0};
  }
  void halt() noexcept override { halted = true; }
  void rearm() noexcept override { halted = false; }
  [[nodiscard]] DeviceFault fault() const noexcept override { return fault_now; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override {
    return DeviceReadiness::needs_homing;
  }
  void calibrate() noexcept override { ++calibrated; }

  DeviceSample at{{10.0, 20.0, -5.0}, {100.0, -50.0, 25.0}, 9};
  Vec3 told_n;
  Vec3 asked_mm;
  double max_n = 0.0;
  bool halted = false;
  int calibrated = 0;
  DeviceFault fault_now = DeviceFault::warm_motors;
};

struct Scaled {
  Scaled() {
    auto own = std::make_unique<Recorder>();
    recorder = own.get();
    device.emplace(std::move(own), kScale);
  }
  Recorder* recorder = nullptr;
  std::optional<ScaledDevice> device;
};

}  // namespace

TEST_CASE("scales correct positions, velocities and delivered forces axis by axis") {
  Scaled lab;
  lab.recorder->at.delivered_n = Vec3{1.0, 1.0, 1.0};
  DeviceSample sample;
  REQUIRE(lab.device->read(sample) == DeviceStatus::ok);
  CHECK(norm(sample.position_mm - Vec3{8.0, 20.0, -8.0}) < 1e-12);
  CHECK(norm(sample.velocity_mm_s - Vec3{80.0, -50.0, 40.0}) < 1e-12);
  CHECK(norm(*sample.delivered_n - Vec3{2.0, 0.5, 1.25}) < 1e-12);
  CHECK(sample.sequence == 9);
}

TEST_CASE("a driver gets the command for which the felt force is the computed one") {
  Scaled lab;
  REQUIRE(lab.device->write({1.0, 1.0, 1.0}) == DeviceStatus::ok);
  CHECK(norm(lab.recorder->told_n - Vec3{0.5, 2.0, 0.8}) < 1e-12);
}

TEST_CASE("a driver's support is queried in its own millimetres, and its force is not scaled") {
  Scaled lab;
  DeviceSample sample;
  REQUIRE(lab.device->read(sample) == DeviceStatus::ok);
  CHECK(lab.device->support_force_n(sample) == Vec3{0.0, 0.7, 0.0});
  CHECK(norm(lab.recorder->asked_mm - Vec3{10.0, 20.0, -5.0}) < 1e-12);
}

TEST_CASE("limits of a scaled device apply to felt and commanded forces, in every direction") {
  const DeviceInfo own = full_info();
  const DeviceInfo info = scaled(own, kScale);
  CHECK(info.scale == kScale);
  CHECK(info.max_force_n == Approx(2.0));
  CHECK(info.continuous_force_n == Approx(0.5));
  CHECK(info.max_stiffness_n_per_mm == Approx(0.8 * 0.5 / 1.6));
  CHECK(info.max_damping_n_s_per_mm == Approx(0.004 * 0.5 / 1.6));
  CHECK(info.workspace->max_mm == Vec3{32.0, 30.0, 32.0});
  CHECK(info.workspace->min_mm == Vec3{-32.0, -30.0, -32.0});
  // A device that delivers more than it is told gets no higher limit.
  const DeviceInfo strong = scaled(own, {{3.0, 2.0, 2.0}, {0.5, 0.5, 0.5}});
  CHECK(strong.max_force_n == own.max_force_n);
  CHECK(strong.max_stiffness_n_per_mm == own.max_stiffness_n_per_mm);
}

TEST_CASE("everything else of a scaled device is the driver's") {
  Scaled lab;
  CHECK(lab.device->fault() == DeviceFault::warm_motors);
  CHECK(lab.device->readiness() == DeviceReadiness::needs_homing);
  lab.device->calibrate();
  CHECK(lab.recorder->calibrated == 1);
  lab.device->halt();
  CHECK(lab.recorder->halted);
  lab.device->rearm();
  CHECK_FALSE(lab.recorder->halted);
}

TEST_CASE("the safety chain's limits apply to true newtons") {
  // Twice as strong as its driver believes: of 3 N felt it may be told 1.5.
  auto own = std::make_unique<Recorder>();
  Recorder& recorder = *own;
  recorder.fault_now = DeviceFault::none;
  recorder.at.velocity_mm_s = {};
  ScaledDevice device(std::move(own), {{2.0, 2.0, 2.0}, {1.0, 1.0, 1.0}});
  ConstantForce force({0.0, 100.0, 0.0});
  KeptSamples kept;
  ServoOptions options{.limit_ticks = 9};
  options.limits.max_force_n = 3.0;
  options.limits.engage_force_n = 1000.0;
  options.limits.ramp_up_s = 0.0;
  static_cast<void>(device::run_servo_in_virtual_time(device, force, kept, options));
  CHECK(recorder.max_n == Approx(1.5));
}

TEST_CASE("a driver is opened with the scales of its settings") {
  DeviceSettings settings;
  CHECK(device::open_device("simulated", settings)->info().scale == DeviceScale{});
  settings.uses["simulated"].scale = kScale;
  CHECK(device::open_device("simulated", settings)->info().scale == kScale);
}

}  // namespace touchtrial

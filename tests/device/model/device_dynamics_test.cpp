// The stages of a modelled device, each against a formula of physics or of sampled systems. The
// laws of the whole are in laws_test.cpp.
#include "device/model/held_devices.hpp"
#include "device/platform/realtime.hpp"
#include "support/catch.hpp"
#include "support/realtime_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchtrial {
namespace {

using device::DeviceDynamics;
using device::DeviceModel;
using TipLoad = DeviceDynamics::TipLoad;

TEST_CASE("a held force moves a free mass as Newton says") {
  DeviceModel model = model_of(0.2);
  model.zero_order_hold = true;
  DeviceDynamics tip(model);
  const Vec3 force_n{0.5, -1.0, 0.25};
  for (int i = 0; i < 400; ++i) tip.tick(force_n, {.mass_kg = 0.3});
  const double t_s = 0.4;
  const Vec3 way_mm = (1000.0 * t_s * t_s / (2.0 * 0.5)) * force_n;
  CHECK(norm(tip.true_position_mm() - way_mm) < 1e-9);
  CHECK(norm(tip.true_velocity_mm_s() - (1000.0 * t_s / 0.5) * force_n) < 1e-9);
}

TEST_CASE("a device without any mass has the least mass") {
  DeviceDynamics tip(model_of(0.0));
  tip.tick({3.0, 0.0, 0.0}, {});
  CHECK(tip.true_velocity_mm_s().x ==
        Approx(1000.0 * kT * 3.0 / DeviceDynamics::kMinMassKg).epsilon(1e-12));
}

// Friction.

TEST_CASE("friction of each axis alone holds more than one newton's worth of a diagonal force") {
  DeviceModel model = model_of(0.1);
  model.coulomb_n = 0.2;
  const Vec3 diagonal_n{0.19, 0.19, -0.19};
  DeviceDynamics isotropic(model);
  isotropic.tick(diagonal_n, {});
  CHECK(norm(isotropic.true_velocity_mm_s()) > 0.0);
  model.friction = device::FrictionShape::per_axis;
  DeviceDynamics per_axis(model);
  per_axis.tick(diagonal_n, {});
  CHECK(per_axis.true_velocity_mm_s() == Vec3{});
  per_axis.tick({0.19, 0.25, 0.0}, {});
  CHECK(per_axis.true_velocity_mm_s().x == 0.0);
  CHECK(per_axis.true_velocity_mm_s().y > 0.0);
}

TEST_CASE("friction falls from static to Coulomb with speed") {
  DeviceModel model = model_of(0.1);
  model.coulomb_n = 0.2;
  model.static_n = 0.6;
  model.stribeck_mm_s = 20.0;
  const double speed_mm_s = GENERATE(5.0, 20.0, 60.0);
  DeviceDynamics tip(model);
  // Heavy enough that one tick changes no speed.
  const TipLoad heavy{.mass_kg = 1000.0};
  tip.tick({1000.0 * speed_mm_s + 0.2, 0.0, 0.0}, heavy);
  const double before = tip.true_velocity_mm_s().x;
  for (int i = 0; i < 10; ++i) tip.tick({}, heavy);
  const double lost_n = (before - tip.true_velocity_mm_s().x) / 10.0 * 1000.1;
  const double ratio = speed_mm_s / 20.0;
  CHECK(lost_n == Approx(0.2 + 0.4 * std::exp(-ratio * ratio)).epsilon(1e-3));
}

// Readings.

TEST_CASE("a velocity from n readings lags a steady acceleration by half of n - 1 ticks") {
  DeviceModel model = model_of(0.1);
  model.zero_order_hold = true;
  model.velocity_readings = GENERATE(2, 5, 20);
  DeviceDynamics tip(model);
  for (int i = 0; i < 200; ++i) tip.tick({0.01, 0.0, -0.02}, {});
  const double lag_s = 0.5 * (model.velocity_readings - 1) * kT;
  CHECK(tip.read_velocity_mm_s().x == Approx(100.0 * (0.2 - lag_s)).epsilon(1e-9));
  CHECK(tip.read_velocity_mm_s().z == Approx(-200.0 * (0.2 - lag_s)).epsilon(1e-9));
  tip.place({5.0, 5.0, 5.0});
  CHECK(tip.read_velocity_mm_s() == Vec3{});
  tip.tick({}, {});
  CHECK(norm(tip.read_velocity_mm_s()) < 1e-9);
}

TEST_CASE("noise has the planted deviation, no mean, and the same numbers from the same seed") {
  DeviceModel model = model_of(0.1);
  model.planted_faults.position_noise_mm = 0.02;
  DeviceDynamics tip(model);
  DeviceDynamics again(model);
  model.planted_faults.seed = 2;
  DeviceDynamics other(model);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kTicks = 20'000;
  int different = 0;
  for (int i = 0; i < kTicks; ++i) {
    for (DeviceDynamics* device : {&tip, &again, &other}) device->tick({}, {});
    REQUIRE(tip.read_position_mm() == again.read_position_mm());
    different += tip.read_position_mm() == other.read_position_mm() ? 0 : 1;
    sum += tip.read_position_mm().x;
    squares += tip.read_position_mm().x * tip.read_position_mm().x;
  }
  CHECK(different == kTicks);
  CHECK(tip.true_position_mm() == Vec3{});
  // Five standard errors.
  CHECK(std::abs(sum / kTicks) < 5.0 * 0.02 / std::sqrt(kTicks));
  CHECK(std::sqrt(squares / kTicks) == Approx(0.02).epsilon(5.0 / std::sqrt(2.0 * kTicks)));
}

// Commands.

TEST_CASE("a command acts after the delay, within the peak, in whole steps") {
  DeviceModel model = model_of(0.1);
  model.delay_ticks = GENERATE(0, 1, 3, 17);
  model.max_force_n = 2.0;
  model.force_step_n = 0.25;
  DeviceDynamics tip(model);
  for (int i = 0; i < 40; ++i) {
    tip.tick(i == 5 ? Vec3{0.6, -0.3, 0.1} : Vec3{}, {});
    const Vec3 expected = i == 5 + model.delay_ticks ? Vec3{0.5, -0.25, 0.0} : Vec3{};
    REQUIRE(tip.delivered_force_n() == expected);
  }
  for (int i = 0; i <= model.delay_ticks; ++i) tip.tick({6.0, 8.0, 0.0}, {});
  CHECK(tip.delivered_force_n() == Vec3{1.25, 1.5, 0.0});  // of (1.2, 1.6)
}

TEST_CASE("planted faults turn and scale forces, and let the handle fall") {
  DeviceModel model = model_of(0.1);
  model.planted_faults.force_sign_scale = {-1.0, 1.2, 0.0};
  model.planted_faults.gravity_n = 0.5;
  DeviceDynamics tip(model);
  tip.tick({0.4, 0.5, 0.6}, {});
  CHECK(tip.delivered_force_n().x == -0.4);
  CHECK(tip.delivered_force_n().y == Approx(0.6));
  CHECK(tip.delivered_force_n().z == 0.0);
  CHECK(tip.true_velocity_mm_s().y == Approx(1000.0 * kT * (0.6 - 0.5) / 0.1));
}

// Structure.

DeviceModel structured(double stiffness_n_per_mm, double tip_share, double damping_ratio) {
  DeviceModel model = model_of(0.045);
  model.structure = {stiffness_n_per_mm, tip_share, damping_ratio};
  return model;
}

TEST_CASE("encoders at the motors do not see a tip that bends while friction holds the motors") {
  DeviceModel model = structured(1.26, 0.5, 1.0);
  model.coulomb_n = 0.26;
  DeviceDynamics device(model);
  for (int i = 0; i < 2000; ++i) {
    device.tick({}, {{0.2, 0.0, 0.0}, 0.05, {0.005, 0.005, 0.005}});
  }
  CHECK(device.read_position_mm() == Vec3{});
  CHECK(device.read_velocity_mm_s() == Vec3{});
  CHECK(device.true_position_mm().x == Approx(0.2 / 1.26).epsilon(1e-6));
}

// A wall.

TEST_CASE(
    "quantised readings keep a wall without friction in motion, and half a step's force stops it") {
  constexpr double kStiffness = 0.4;
  constexpr double kStepMm = 0.055;
  const auto late_speed = [](double coulomb_n) {
    DeviceModel model = model_of(0.1);
    model.position_step_mm = kStepMm;
    model.coulomb_n = coulomb_n;
    model.zero_order_hold = true;
    DeviceDynamics tip(model);
    tip.place({0.0, 0.0, -1.77});
    double fastest_mm_s = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      const double depth_mm = std::max(0.0, -tip.read_position_mm().z);
      tip.tick({0.0, 0.0, kStiffness * depth_mm}, {{0.0, 0.0, -0.7}});
      if (i >= 15'000) fastest_mm_s = std::max(fastest_mm_s, norm(tip.true_velocity_mm_s()));
    }
    return fastest_mm_s;
  };
  CHECK(late_speed(0.0) > 0.1);
  CHECK(late_speed(1.1 * 0.5 * kStiffness * kStepMm) == 0.0);
}

TEST_CASE("a tick neither allocates nor locks, with every stage in use") {
  DeviceModel model = device::device_model("touch");
  model.static_n = 0.4;
  model.stribeck_mm_s = 5.0;
  model.lowpass_hz = 200.0;
  model.planted_faults.position_noise_mm = 0.01;
  DeviceDynamics tip(model);
  static_cast<void>(take_realtime_offences());
  {
    const device::RealtimeRegion region;
    for (int i = 0; i < 100; ++i) tip.tick({0.5, 0.1, 0.0}, {.mass_kg = 0.1});
  }
  CHECK(take_realtime_offences() == RealtimeOffences{});
  CHECK(is_finite(tip.true_position_mm()));
}

TEST_CASE("a tick that is no time is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double tick_s : {0.0, -0.001, 0.011, nan}) {
    CHECK_THROWS_AS(DeviceDynamics(model_of(0.1), tick_s), std::invalid_argument);
  }
}

}  // namespace
}  // namespace touchtrial

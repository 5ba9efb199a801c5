// Laws of a modelled device, each against a formula of physics or of sampled systems.
#include "device/model/device_model.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/servo.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "support/catch.hpp"
#include "support/realtime_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

namespace touchtrial {
namespace {

using device::DeviceDynamics;
using device::DeviceModel;
using device::FrictionShape;
using Outside = DeviceDynamics::Outside;

constexpr double kT = 0.001;
constexpr double kPi = std::numbers::pi;

DeviceModel model_of(double mass_kg) {
  DeviceModel model;
  model.name = "test";
  model.mass_kg = mass_kg;
  return model;
}

Vec3 random_vec(RandomStream& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

/// A spring to a place, in the world outside.
Outside spring(const DeviceDynamics& tip, double stiffness_n_per_mm, Vec3 place_mm = {}) {
  return {stiffness_n_per_mm * (place_mm - tip.true_position_mm())};
}

/// The simulated hand's equations, written out: a mass without a device, by the semi-implicit step.
struct PlainHand {
  device::HandOptions options;
  Vec3 position_mm;
  Vec3 velocity_mm_s;

  /// What the hand does to the tip.
  [[nodiscard]] Outside outside(double time_s, const device::PathPoint& target) const {
    const double u = std::min(time_s / device::SimulatedHand::kPushBuildUpS, 1.0);
    const Vec2 off_mm = target.position_mm - Vec2{position_mm.x, position_mm.y};
    const double damping = options.arm_damping_n_s_per_mm;
    const Vec2 pull_n = options.arm_stiffness_n_per_mm * off_mm + damping * target.velocity_mm_s;
    return {{pull_n.x, pull_n.y, -(options.push_n * (u * u * (3.0 - 2.0 * u)))},
            options.mass_kg,
            {damping, damping, options.push_damping_n_s_per_mm}};
  }
  void tick(Vec3 force_n, const Outside& hand) {
    const double tick_per_mass = kT * 1000.0 / options.mass_kg;
    const auto after = [tick_per_mass](double before_mm_s, double n, double damping) {
      return (before_mm_s + tick_per_mass * n) / (1.0 + tick_per_mass * damping);
    };
    const Vec3 all_n = force_n + hand.force_n;
    velocity_mm_s = {after(velocity_mm_s.x, all_n.x, hand.damping_n_s_per_mm.x),
                     after(velocity_mm_s.y, all_n.y, hand.damping_n_s_per_mm.y),
                     after(velocity_mm_s.z, all_n.z, hand.damping_n_s_per_mm.z)};
    position_mm = position_mm + kT * velocity_mm_s;
  }
};

TEST_CASE("a hand moves by the same equations with an ideal device and without one, bit for bit") {
  const device::HandOptions options{
      .arm_damping_n_s_per_mm = 0.006, .push_damping_n_s_per_mm = 0.011, .explore_s = 5.0};
  RandomStream path_random(4, "device_dynamics_test");
  const device::ExplorationPath path({0.2, 500, 500}, {.duration_s = 5.0}, path_random);
  device::SimulatedHand simulated(options, path);
  device::DeviceSample sample;
  REQUIRE(simulated.read(sample) == device::DeviceStatus::ok);
  PlainHand plain{options, sample.position_mm, {}};
  DeviceDynamics dynamics(device::device_model("ideal"));
  dynamics.place(sample.position_mm);
  RandomStream random(5, "device_dynamics_test");
  std::size_t stroke = 0;
  for (int i = 0; i < 4999; ++i) {
    const Vec3 force_n = random_vec(random, 1.0);
    const Outside hand =
        plain.outside(i * device::kServoTickS, path.at(i * device::kServoTickS, stroke));
    plain.tick(force_n, hand);
    dynamics.tick(force_n, hand);
    REQUIRE(simulated.write(force_n) == device::DeviceStatus::ok);
    REQUIRE(simulated.read(sample) == device::DeviceStatus::ok);
    REQUIRE(dynamics.read_position_mm() == plain.position_mm);
    REQUIRE(dynamics.read_velocity_mm_s() == plain.velocity_mm_s);
    REQUIRE(sample.position_mm == plain.position_mm);
    REQUIRE(sample.velocity_mm_s == plain.velocity_mm_s);
  }
}

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
        Approx(1000.0 * kT * 3.0 / DeviceDynamics::kLeastMassKg).epsilon(1e-12));
}

// Friction.

TEST_CASE("at rest a force up to static friction moves nothing, and a greater one does") {
  DeviceModel model = model_of(0.1);
  model.coulomb_n = 0.2;
  model.static_n = GENERATE(0.0, 0.35);
  model.zero_order_hold = GENERATE(false, true);
  const double holds_n = std::max(model.static_n, model.coulomb_n);
  DeviceDynamics tip(model);
  tip.place({1.0, 2.0, 3.0});
  RandomStream random(1, "device_dynamics_test");
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = random_vec(random, 1.0);
    tip.tick((random.uniform(0.0, 0.999) * holds_n / norm(direction)) * direction,
             {.damping_n_s_per_mm = {0.01, 0.0, 0.02}});
  }
  tip.tick({holds_n, 0.0, 0.0}, {});
  CHECK(tip.true_velocity_mm_s() == Vec3{});
  CHECK(tip.true_position_mm() == Vec3{1.0, 2.0, 3.0});
  tip.tick({1.01 * holds_n, 0.0, 0.0}, {});
  CHECK(tip.true_velocity_mm_s().x > 0.0);
}

TEST_CASE("friction of each axis alone holds more than one newton's worth of a diagonal force") {
  DeviceModel model = model_of(0.1);
  model.coulomb_n = 0.2;
  const Vec3 diagonal_n{0.19, 0.19, -0.19};
  DeviceDynamics isotropic(model);
  isotropic.tick(diagonal_n, {});
  CHECK(norm(isotropic.true_velocity_mm_s()) > 0.0);
  model.friction = FrictionShape::per_axis;
  DeviceDynamics per_axis(model);
  per_axis.tick(diagonal_n, {});
  CHECK(per_axis.true_velocity_mm_s() == Vec3{});
  per_axis.tick({0.19, 0.25, 0.0}, {});
  CHECK(per_axis.true_velocity_mm_s().x == 0.0);
  CHECK(per_axis.true_velocity_mm_s().y > 0.0);
}

TEST_CASE("friction never adds energy, never turns the motion, and is never above its limit") {
  DeviceModel model = model_of(0.08);
  model.coulomb_n = 0.25;
  model.static_n = GENERATE(0.0, 0.5);
  model.stribeck_mm_s = model.static_n > 0.0 ? 10.0 : 0.0;
  model.viscous_n_s_per_m = 0.7;
  model.zero_order_hold = true;
  DeviceDynamics tip(model);
  RandomStream random(2, "device_dynamics_test");
  const double tick_per_mass = 1000.0 * kT / (0.08 + 0.02);
  const double damping = 0.7e-3 + 0.004;
  int moving = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 before = tip.true_velocity_mm_s();
    const Vec3 force_n = random_vec(random, 1.2);
    tip.tick(force_n, {.mass_kg = 0.02, .damping_n_s_per_mm = {0.004, 0.004, 0.004}});
    const Vec3 after = tip.true_velocity_mm_s();
    const double per_newton = tick_per_mass / (1.0 + tick_per_mass * damping);
    const Vec3 without =
        (1.0 / (1.0 + tick_per_mass * damping)) * (before + tick_per_mass * force_n);
    const Vec3 friction_n = (1.0 / per_newton) * (without - after);
    REQUIRE(dot(after, after) <= dot(without, without));
    REQUIRE(dot(after, without) >= 0.0);
    REQUIRE(norm(friction_n) <= std::max(model.coulomb_n, model.static_n) + 1e-9);
    moving += norm(after) > 0.0 ? 1 : 0;
  }
  CHECK(moving > 10'000);
}

TEST_CASE("a mass on a spring loses four times F / k of amplitude a cycle to Coulomb friction") {
  constexpr double kStiffness = 0.4;  // N/mm
  DeviceModel model = model_of(0.1);
  model.coulomb_n = 0.06;
  model.zero_order_hold = true;
  DeviceDynamics tip(model);
  tip.place({4.0, 0.0, 0.0});
  // The spring's own force is computed by the tick and so excites a little; its motion over half a
  // tick takes that away.
  std::vector<double> peaks_mm;
  double before_mm = 4.0;
  double last_mm = 4.0;
  for (int i = 0; i < 2000; ++i) {
    const double seen_mm = tip.true_position_mm().x + 0.5 * kT * tip.true_velocity_mm_s().x;
    tip.tick({}, {{-kStiffness * seen_mm, 0.0, 0.0}});
    const double now_mm = tip.true_position_mm().x;
    if (last_mm > before_mm && last_mm > now_mm) peaks_mm.push_back(last_mm);
    before_mm = last_mm;
    last_mm = now_mm;
  }
  REQUIRE(peaks_mm.size() >= 3);
  double expected_mm = 4.0;
  for (std::size_t i = 0; i < 3; ++i) {
    expected_mm -= 4.0 * 0.06 / kStiffness;
    CHECK(peaks_mm[i] == Approx(expected_mm).margin(0.05));
  }
  CHECK(tip.true_velocity_mm_s() == Vec3{});
  CHECK(std::abs(kStiffness * last_mm) <= 0.06 + 1e-9);
}

TEST_CASE("friction falls from static to Coulomb with speed") {
  DeviceModel model = model_of(0.1);
  model.coulomb_n = 0.2;
  model.static_n = 0.6;
  model.stribeck_mm_s = 20.0;
  const double speed_mm_s = GENERATE(5.0, 20.0, 60.0);
  DeviceDynamics tip(model);
  // Heavy enough that one tick changes no speed.
  const Outside heavy{.mass_kg = 1000.0};
  tip.tick({1000.0 * speed_mm_s + 0.2, 0.0, 0.0}, heavy);
  const double before = tip.true_velocity_mm_s().x;
  for (int i = 0; i < 10; ++i) tip.tick({}, heavy);
  const double lost_n = (before - tip.true_velocity_mm_s().x) / 10.0 * 1000.1;
  const double ratio = speed_mm_s / 20.0;
  CHECK(lost_n == Approx(0.2 + 0.4 * std::exp(-ratio * ratio)).epsilon(1e-3));
}

/// Strokes along x at 100 mm/s by an arm, while a texture's force pushes along it.
/// \return the amplitude of the motion about the stroke at the force's frequency
double amplitude_along_stroke(double coulomb_n, double frequency_hz) {
  DeviceModel model = model_of(0.1);
  model.coulomb_n = coulomb_n;
  DeviceDynamics tip(model);
  std::complex<double> sum;
  constexpr int kSettled = 2000;
  constexpr int kTicks = 6000;
  for (int i = 0; i < kTicks; ++i) {
    const double t_s = i * kT;
    const double target_mm = 100.0 * t_s;
    if (i >= kSettled) {
      sum +=
          (tip.true_position_mm().x - target_mm) * std::polar(1.0, -2.0 * kPi * frequency_hz * t_s);
    }
    const double pull_n = 0.2 * (target_mm - tip.true_position_mm().x) + 0.008 * 100.0;
    tip.tick({0.1 * std::sin(2.0 * kPi * frequency_hz * t_s), 0.0, 0.0},
             {{pull_n, 0.0, 0.0}, 0.0, {0.008, 0.008, 0.008}});
  }
  return 2.0 * std::abs(sum) / (kTicks - kSettled);
}

TEST_CASE("at constant speed the spectrum along a stroke does not depend on Coulomb friction") {
  const double frequency_hz = GENERATE(10.0, 40.0, 160.0);
  const double without_mm = amplitude_along_stroke(0.0, frequency_hz);
  REQUIRE(without_mm > 0.0);
  CHECK(amplitude_along_stroke(0.3, frequency_hz) == Approx(without_mm).epsilon(0.01));
}

// Readings.

TEST_CASE("readings are whole steps, and at most half a step wrong") {
  DeviceModel model = model_of(0.1);
  model.position_step_mm = GENERATE(0.055, 0.01);
  DeviceDynamics tip(model);
  RandomStream random(3, "device_dynamics_test");
  const double step_mm = model.position_step_mm;
  for (int i = 0; i < 5000; ++i) {
    tip.tick(random_vec(random, 2.0), spring(tip, 0.1));
    const Vec3 read = tip.read_position_mm();
    for (const double value : {read.x, read.y, read.z}) {
      REQUIRE(std::abs(value / step_mm - std::round(value / step_mm)) < 1e-9);
    }
    const Vec3 wrong = read - tip.true_position_mm();
    for (const double value : {wrong.x, wrong.y, wrong.z}) {
      REQUIRE(std::abs(value) <= 0.5 * step_mm * (1.0 + 1e-9));
    }
  }
}

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
  model.planted.position_noise_mm = 0.02;
  DeviceDynamics tip(model);
  DeviceDynamics again(model);
  model.planted.seed = 2;
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

TEST_CASE("the low-pass answers a step as a resistor and a capacitor do") {
  DeviceModel model = model_of(0.1);
  model.lowpass_hz = GENERATE(5.0, 100.0, 1000.0);
  DeviceDynamics tip(model);
  for (int i = 1; i <= 50; ++i) {
    tip.tick({2.0, 0.0, -1.0}, {});
    const double share = 1.0 - std::exp(-2.0 * kPi * model.lowpass_hz * i * kT);
    REQUIRE(tip.delivered_force_n().x == Approx(2.0 * share).epsilon(1e-12));
    REQUIRE(tip.delivered_force_n().z == Approx(-share).epsilon(1e-12));
  }
  tip.place({});
  tip.tick({}, {});
  CHECK(tip.delivered_force_n() == Vec3{});
}

TEST_CASE("planted faults turn and scale forces, and let the handle fall") {
  DeviceModel model = model_of(0.1);
  model.planted.force_sign_scale = {-1.0, 1.2, 0.0};
  model.planted.gravity_n = 0.5;
  DeviceDynamics tip(model);
  tip.tick({0.4, 0.5, 0.6}, {});
  CHECK(tip.delivered_force_n().x == -0.4);
  CHECK(tip.delivered_force_n().y == Approx(0.6));
  CHECK(tip.delivered_force_n().z == 0.0);
  CHECK(tip.true_velocity_mm_s().y == Approx(1000.0 * kT * (0.6 - 0.5) / 0.1));
}

// Linear stages together.

struct Linear {
  double mass_kg, stiffness_n_per_mm, damping_n_s_per_mm, lowpass_hz;
  int delay_ticks;
  bool hold;
};

DeviceModel model_of(const Linear& linear) {
  DeviceModel model = model_of(linear.mass_kg);
  model.viscous_n_s_per_m = 500.0 * linear.damping_n_s_per_mm;  // the other half comes from outside
  model.lowpass_hz = linear.lowpass_hz;
  model.delay_ticks = linear.delay_ticks;
  model.zero_order_hold = linear.hold;
  return model;
}

/// \return the steady amplitude at x under a sine of 1 N, by correlation over whole periods
double steady_amplitude_mm(const DeviceModel& model, double frequency_hz, double stiffness_n_per_mm,
                           double damping_n_s_per_mm) {
  DeviceDynamics tip(model);
  std::complex<double> sum;
  constexpr int kSettled = 20'000;
  constexpr int kCounted = 2000;  // whole periods of every multiple of 0.5 Hz
  for (int i = 0; i < kSettled + kCounted; ++i) {
    const double phase = 2.0 * kPi * frequency_hz * i * kT;
    if (i >= kSettled) sum += tip.true_position_mm().x * std::polar(1.0, -phase);
    Outside outside = spring(tip, stiffness_n_per_mm);
    outside.damping_n_s_per_mm = {damping_n_s_per_mm, damping_n_s_per_mm, damping_n_s_per_mm};
    tip.tick({std::sin(phase), 0.0, 0.0}, outside);
  }
  return 2.0 * std::abs(sum) / kCounted;
}

/// The same by the z-transform. With a = T / m and g = 1 / (1 + a b):
/// (z - g) V = g a (U - k P), and (z - 1) P = T z V, or T (1 + z) / 2 V where the force is held.
double discrete_amplitude_mm(const Linear& l, double frequency_hz) {
  const std::complex<double> z = std::polar(1.0, 2.0 * kPi * frequency_hz * kT);
  const double a = 1000.0 * kT / l.mass_kg;
  const double g = 1.0 / (1.0 + a * l.damping_n_s_per_mm);
  const std::complex<double> mean = l.hold ? 0.5 * (1.0 + z) : z;
  const std::complex<double> path = kT * mean / (z - 1.0) * g * a / (z - g);
  std::complex<double> motors = std::pow(z, -l.delay_ticks);
  if (l.lowpass_hz > 0.0) {
    const double share = 1.0 - std::exp(-2.0 * kPi * l.lowpass_hz * kT);
    motors *= share * z / (z - (1.0 - share));
  }
  return std::abs(motors * path / (1.0 + l.stiffness_n_per_mm * path));
}

TEST_CASE("the steady amplitude under a sine is that of the discrete transfer function") {
  const Linear linear = GENERATE(
      as<Linear>{}, Linear{0.1, 0.2, 0.008, 0.0, 0, false}, Linear{0.045, 0.4, 0.003, 0.0, 1, true},
      Linear{0.25, 1.0, 0.02, 80.0, 3, true}, Linear{0.03, 0.1, 0.001, 400.0, 0, false});
  const double frequency_hz = GENERATE(0.5, 5.0, 10.0, 40.0, 160.0, 320.0, 480.0);
  const double measured_mm = steady_amplitude_mm(
      model_of(linear), frequency_hz, linear.stiffness_n_per_mm, 0.5 * linear.damping_n_s_per_mm);
  CHECK(measured_mm == Approx(discrete_amplitude_mm(linear, frequency_hz)).epsilon(1e-6));
}

TEST_CASE("well below the servo's rate the steady amplitude is 1 / |k - m w^2 + i w b|") {
  const bool hold = GENERATE(false, true);
  const double frequency_hz = GENERATE(1.0, 5.0, 20.0, 30.0);
  constexpr double kMassKg = 0.1;
  constexpr double kStiffness = 0.2;  // N/mm
  constexpr double kDamping = 0.008;  // N s/mm
  DeviceModel model = model_of(kMassKg);
  model.zero_order_hold = hold;
  const double w = 2.0 * kPi * frequency_hz;
  const double expected_mm =
      1.0 / std::abs(std::complex<double>(kStiffness - 0.001 * kMassKg * w * w, w * kDamping));
  CHECK(steady_amplitude_mm(model, frequency_hz, kStiffness, kDamping) ==
        Approx(expected_mm).epsilon(0.05));
}

// Structure.

DeviceModel structured(double stiffness_n_per_mm, double tip_share, double damping_ratio) {
  DeviceModel model = model_of(0.045);
  model.structure = {stiffness_n_per_mm, tip_share, damping_ratio};
  return model;
}

TEST_CASE("a sine at the motors moves a structure's tip by the discrete transfer function") {
  const double k = GENERATE(1.26, 3.5);
  const double share = GENERATE(0.5, 0.2);
  const double frequency_hz = GENERATE(2.0, 20.0, 45.0, 60.0, 200.0, 450.0);
  DeviceModel model = structured(k, share, 0.1);
  model.viscous_n_s_per_m = 2.0;
  constexpr double kHand = 0.003;  // N s/mm
  // The trapezium rule puts w = (2 / T) (z - 1) / (z + 1) for s; a force that is held over the
  // tick, and an implicit damper, count where the tick ends.
  const std::complex<double> z = std::polar(1.0, 2.0 * kPi * frequency_hz * kT);
  const std::complex<double> w = 2.0 / kT * (z - 1.0) / (z + 1.0);
  const double tip = 0.001 * 0.045 * share;
  const double motor = 0.001 * 0.045 - tip;
  const std::complex<double> joint = k + 2.0 * 0.1 * std::sqrt(k * tip) * w;
  const std::complex<double> implicit = 2.0 * z / (1.0 + z) * w;
  const std::complex<double> at_motor = motor * w * w + 0.002 * implicit + joint;
  const std::complex<double> at_tip = tip * w * w + kHand * implicit + joint;
  const std::complex<double> moved = 2.0 / (1.0 + z) * joint / (at_motor * at_tip - joint * joint);
  CHECK(steady_amplitude_mm(model, frequency_hz, 0.0, kHand) ==
        Approx(std::abs(moved)).epsilon(1e-4));
}

TEST_CASE("a stiff structure moves like a rigid device") {
  DeviceModel rigid = model_of(0.045);
  rigid.viscous_n_s_per_m = 3.0;
  rigid.zero_order_hold = true;
  DeviceModel stiff = rigid;
  stiff.structure = {1000.0, 0.5, 1.0};
  DeviceDynamics a(rigid);
  DeviceDynamics b(stiff);
  for (int i = 0; i < 500; ++i) {
    const Vec3 force_n{0.3 * std::sin(0.05 * i), 0.1, -0.2 * std::cos(0.03 * i)};
    a.tick(force_n, {.mass_kg = 0.1});
    b.tick(force_n, {.mass_kg = 0.1});
  }
  CHECK(norm(a.true_position_mm()) > 1.0);
  CHECK(norm(a.true_position_mm() - b.true_position_mm()) < 1e-3 * norm(a.true_position_mm()));
}

TEST_CASE("an undamped structure keeps its energy, and rings at its own frequency") {
  const double k = GENERATE(1.26, 50.0, 1000.0);
  DeviceDynamics device(structured(k, 0.5, 0.0));
  device.tick({2.0, 0.0, 0.0}, {});
  // The mean of both masses' velocities is what the pulse gave the whole device.
  const double mean_mm_s = 2.0 * 1000.0 * kT / 0.045;
  std::vector<double> crossings_s;
  double last = 0.0;
  double greatest = 0.0;
  double late_greatest = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    device.tick({}, {});
    const double relative = device.true_velocity_mm_s().x - mean_mm_s;
    if (last < 0.0 && relative >= 0.0) {
      crossings_s.push_back(kT * (i - relative / (relative - last)));
    }
    last = relative;
    (i < 10'000 ? greatest : late_greatest) =
        std::max(i < 10'000 ? greatest : late_greatest, std::abs(relative));
  }
  CHECK(late_greatest == Approx(greatest).epsilon(0.01));
  REQUIRE(crossings_s.size() > 100);
  const double measured_hz =
      static_cast<double>(crossings_s.size() - 1) / (crossings_s.back() - crossings_s.front());
  const double natural = std::sqrt(k / (0.001 * 0.045 * 0.25));
  // The trapezium rule bends frequencies as the bilinear transform does.
  const double expected_hz = std::atan(0.5 * natural * kT) / (kPi * kT);
  CHECK(measured_hz == Approx(expected_hz).epsilon(1e-3));
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

/// Pushes the tip on a wall, kicks it by less than 0.1 mm, and waits.
/// \return how many times greater the motion is in the last 0.4 s than in the first
double growth_on_wall(double stiffness_n_per_mm, double damping_n_s_per_m, int delay_ticks) {
  DeviceModel model = model_of(0.5);
  model.viscous_n_s_per_m = damping_n_s_per_m;
  model.delay_ticks = delay_ticks;
  model.zero_order_hold = true;
  DeviceDynamics tip(model);
  constexpr double kPushN = 0.7;
  const double rest_mm = -kPushN / stiffness_n_per_mm;
  tip.place({0.0, 0.0, rest_mm});
  for (int i = 0; i < delay_ticks; ++i) tip.tick({0.0, 0.0, kPushN}, {{0.0, 0.0, -kPushN}});
  tip.tick({0.0, 0.0, kPushN}, {{0.0, 0.0, -kPushN + 0.5}});
  double first_mm = 0.0;
  double last_mm = 0.0;
  constexpr int kTicks = 40'000;
  for (int i = 0; i < kTicks; ++i) {
    const double depth_mm = std::max(0.0, -tip.read_position_mm().z);
    tip.tick({0.0, 0.0, stiffness_n_per_mm * depth_mm}, {{0.0, 0.0, -kPushN}});
    const double away_mm = std::abs(tip.true_position_mm().z - rest_mm);
    if (i < 400) first_mm = std::max(first_mm, away_mm);
    if (i >= kTicks - 400) last_mm = std::max(last_mm, away_mm);
  }
  return last_mm / first_mm;
}

TEST_CASE("a wall with K (T / 2 + delay) below the damping settles, and above it does not") {
  const double stiffness_n_per_mm = GENERATE(0.2, 0.4, 1.0);
  const int delay_ticks = GENERATE(0, 1, 3);
  const double bound_n_s_per_m =
      1000.0 * stiffness_n_per_mm * kT * (0.5 + static_cast<double>(delay_ticks));
  INFO(stiffness_n_per_mm << " N/mm, delay of " << delay_ticks << " ticks");
  CHECK(growth_on_wall(stiffness_n_per_mm, 1.3 * bound_n_s_per_m, delay_ticks) < 0.5);
  CHECK(growth_on_wall(stiffness_n_per_mm, 0.7 * bound_n_s_per_m, delay_ticks) > 1.5);
}

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
  model.planted.position_noise_mm = 0.01;
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

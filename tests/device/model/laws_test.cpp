// The laws of a device in a hand, a test case each, against closed forms or an independent
// computation: on every shipped model and in both hands where the law speaks of them. Those of
// linear devices are in linear_laws_test.cpp.
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/model/held_devices.hpp"
#include "device/servo/servo.hpp"
#include "support/catch.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using namespace device;
using Complex = std::complex<double>;

/// The simulated hand's equations, written out: a mass without a device, by the semi-implicit step.
struct PlainHand {
  HandOptions options;
  Vec3 position_mm;
  Vec3 velocity_mm_s;

  void tick(double time_s, Vec3 force_n, const PathPoint& target) {
    const double u = std::min(time_s / device::SimulatedHand::kPushBuildUpS, 1.0);
    const Vec2 off_mm = target.position_mm - Vec2{position_mm.x, position_mm.y};
    const double arm = options.arm_damping_n_s_per_mm;
    const Vec2 pull_n = options.arm_stiffness_n_per_mm * off_mm + arm * target.velocity_mm_s;
    const Vec3 all_n =
        force_n + Vec3{pull_n.x, pull_n.y, -(options.push_n * (u * u * (3.0 - 2.0 * u)))};
    const double tick_per_mass = kT * 1000.0 / options.mass_kg;
    const auto after = [tick_per_mass](double before_mm_s, double n, double damping) {
      return (before_mm_s + tick_per_mass * n) / (1.0 + tick_per_mass * damping);
    };
    velocity_mm_s = {after(velocity_mm_s.x, all_n.x, arm), after(velocity_mm_s.y, all_n.y, arm),
                     after(velocity_mm_s.z, all_n.z, options.push_damping_n_s_per_mm)};
    position_mm = position_mm + kT * velocity_mm_s;
  }
};

TEST_CASE("law 1: an ideal device moves the point mass as no device does, bit for bit") {
  HandOptions options{
      .arm_damping_n_s_per_mm = 0.006, .push_damping_n_s_per_mm = 0.011, .explore_s = 5.0};
  options.model = HandKind::point_mass;
  options.factors = {1.0, 1.0, 1.0};
  RandomStream path_random(4, "device_dynamics_test");
  const device::ExplorationPath path({0.2, 500, 500}, {.duration_s = 5.0}, path_random);
  device::SimulatedHand simulated(options, path, device_model("ideal"));
  DeviceSample sample;
  REQUIRE(simulated.read(sample) == DeviceStatus::ok);
  PlainHand plain{options, sample.position_mm, {}};
  RandomStream random(5, "device_dynamics_test");
  std::size_t stroke = 0;
  for (int i = 0; i < 4999; ++i) {
    const double time_s = i * kServoTickS;
    const Vec3 force_n = random_vec(random, 1.0);
    const PathPoint target = path.at(time_s, stroke);
    plain.tick(time_s, force_n, target);
    REQUIRE(simulated.write(force_n) == DeviceStatus::ok);
    REQUIRE(simulated.read(sample) == DeviceStatus::ok);
    REQUIRE(sample.position_mm == plain.position_mm);
    REQUIRE(sample.velocity_mm_s == plain.velocity_mm_s);
  }
}

/// Pushes at random by less than friction holds, then by more.
void require_rest(DeviceModel model, const HandOptions& options, double holds_n) {
  model = unrounded(model);
  HeldDevice held(options, model);
  const Vec3 place_mm{1.0, 2.0, 3.0};
  held.place(place_mm);
  const PathPoint there{{1.0, 2.0}, {}};
  RandomStream random(1, "laws_test");
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = random_vec(random, 1.0);
    held.tick((random.uniform(0.0, 0.999) * holds_n / norm(direction)) * direction, there, 0.0);
    REQUIRE(held.device.true_velocity_mm_s() == Vec3{});
  }
  REQUIRE(held.device.true_position_mm() == place_mm);
  for (int i = 0; i <= model.delay_ticks; ++i) held.tick({1.01 * holds_n, 0.0, 0.0}, there, 0.0);
  REQUIRE(held.device.read_velocity_mm_s().x > 0.0);
}

TEST_CASE("law 2: at rest, forces up to static friction move nothing, exactly") {
  for_every_device_in_every_hand([](DeviceModel model, const HandOptions& options) {
    if (model.coulomb_n == 0.0) return;
    require_rest(model, options, model.coulomb_n);
    model.static_n = 1.5 * model.coulomb_n;
    model.stribeck_mm_s = 5.0;
    require_rest(model, options, model.static_n);
    model.friction = FrictionShape::per_axis;
    require_rest(model, options, model.static_n);
  });
}

/// Kinetic and elastic energy of device and grip, mN mm, from the published numbers of the grip.
double energy_of(const HeldDevice& held, const DeviceModel& model) {
  constexpr std::array kMass{0.218, 0.204, 0.269};
  constexpr std::array kFinger{0.380, 0.770, 0.552};  // N/mm
  constexpr std::array kArm{0.079, 0.272, 0.0};
  const double share = model.structure.stiffness_n_per_mm > 0.0 ? model.structure.tip_share : 1.0;
  const auto tip = axes_of(held.device.true_position_mm());
  const auto tip_speed = axes_of(held.device.true_velocity_mm_s());
  const auto motor = axes_of(held.device.read_position_mm());
  const auto motor_speed = axes_of(held.device.read_velocity_mm_s());
  const auto mass = axes_of(held.hand.position_mm());
  const auto mass_speed = axes_of(held.hand.velocity_mm_s());
  double twice = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    twice += model.mass_kg * share * tip_speed[i] * tip_speed[i] +
             model.mass_kg * (1.0 - share) * motor_speed[i] * motor_speed[i] +
             kMass[i] * mass_speed[i] * mass_speed[i];
    const double joint_mm = motor[i] - tip[i];
    const double finger_mm = mass[i] - tip[i];
    twice += 1000.0 * (model.structure.stiffness_n_per_mm * joint_mm * joint_mm +
                       kFinger[i] * finger_mm * finger_mm + kArm[i] * mass[i] * mass[i]);
  }
  return 0.5 * twice;
}

/// The way that axes go, within a tick, other than with the velocity with which they end.
double turned_way_mm(Vec3 was_mm_s, Vec3 is_mm_s) {
  const auto was = axes_of(was_mm_s);
  const auto is = axes_of(is_mm_s);
  double way_mm = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double mean_mm_s = 0.5 * (was[i] + is[i]);
    if (is[i] == 0.0 || mean_mm_s * is[i] < 0.0) way_mm += kT * std::abs(mean_mm_s);
  }
  return way_mm;
}

TEST_CASE("law 3: friction never adds energy; without it nothing is lost") {
  for (const DeviceModel& shipped : shipped_device_models()) {
    if (shipped.coulomb_n == 0.0) continue;
    INFO(shipped.name);
    DeviceModel model = unrounded(shipped);
    model.viscous_n_s_per_m = 0.0;
    model.structure.damping_ratio = 0.0;
    HandOptions undamped{.model = HandKind::stylus_grip};
    undamped.factors.damping = 0.0;
    const DeviceModel slick_model = frictionless(model);
    HeldDevice held(undamped, model);
    HeldDevice slick(undamped, slick_model);
    for (HeldDevice* each : {&held, &slick}) each->place({5.0, -3.0, 1.0});
    const double at_start = energy_of(slick, slick_model);
    double before = at_start;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 was_mm_s = held.device.read_velocity_mm_s();
      held.tick({}, {}, 0.0);
      slick.tick({}, {}, 0.0);
      const double after = energy_of(held, model);
      // Friction acts against the velocity with which a tick ends; where an axis stops or turns in
      // the tick, the way until then may count the wrong way.
      const Vec3 is_mm_s = held.device.read_velocity_mm_s();
      const double turned_mm = turned_way_mm(was_mm_s, is_mm_s);
      REQUIRE(after <= before + 1e-12 * at_start + 1000.0 * model.coulomb_n * turned_mm);
      before = after;
      REQUIRE(energy_of(slick, slick_model) == Approx(at_start).epsilon(1e-9));
    }
    // The hand swings on, and an undamped structure, while friction holds the motors.
    CHECK(before < 0.9 * at_start);
    CHECK(held.device.read_velocity_mm_s() == Vec3{});
  }
}

TEST_CASE("law 3: in any motion friction takes speed, never turns it, and is within its limit") {
  DeviceModel model = model_of(0.08);
  model.zero_order_hold = true;
  model.coulomb_n = 0.25;
  model.static_n = GENERATE(0.0, 0.5);
  model.stribeck_mm_s = model.static_n > 0.0 ? 10.0 : 0.0;
  model.viscous_n_s_per_m = 0.7;
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

/// The amplitude of the tip's motion about a stroke along x at 100 mm/s, while a texture of 0.05 N
/// pushes along it.
double amplitude_along_stroke(const DeviceModel& model, const HandOptions& options,
                              double frequency_hz) {
  HeldDevice held(options, model);
  Complex sum;
  constexpr int kSettled = 3000;
  constexpr int kTicks = 7000;
  for (int i = 0; i < kTicks; ++i) {
    const double t_s = i * kT;
    const double phase = 2.0 * kPi * frequency_hz * t_s;
    if (i >= kSettled) {
      sum += (held.device.true_position_mm().x - 100.0 * t_s) * std::polar(1.0, -phase);
    }
    held.tick({0.05 * std::sin(phase), 0.0, 0.0}, {{100.0 * t_s, 0.0}, {100.0, 0.0}}, 0.0);
  }
  return 2.0 * std::abs(sum) / (kTicks - kSettled);
}

TEST_CASE(
    "law 4: at constant speed Coulomb friction leaves the spectrum along the stroke as it is") {
  const double frequency_hz = GENERATE(10.0, 40.0, 160.0);
  for_every_device_in_every_hand([=](const DeviceModel& shipped, const HandOptions& options) {
    const DeviceModel model = unrounded(shipped);
    const double without_mm = amplitude_along_stroke(frictionless(model), options, frequency_hz);
    REQUIRE(without_mm > 0.0);
    CHECK(amplitude_along_stroke(model, options, frequency_hz) == Approx(without_mm).epsilon(0.01));
  });
}

TEST_CASE("law 5: readings are whole steps, and at most half a step wrong") {
  for_every_device_in_every_hand([](const DeviceModel& model, const HandOptions& options) {
    if (model.position_step_mm == 0.0) return;
    DeviceModel continuous = model;
    continuous.position_step_mm = 0.0;
    continuous.velocity_readings = 0;
    HeldDevice held(options, model);
    HeldDevice truth(options, continuous);  // readings do not act back on forces from outside
    RandomStream random(3, "laws_test");
    const double step_mm = model.position_step_mm;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 force_n = random_vec(random, 2.0);
      for (HeldDevice* each : {&held, &truth}) each->tick(force_n, {}, 0.0);
      const auto read = axes_of(held.device.read_position_mm());
      const auto at = axes_of(truth.device.read_position_mm());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        REQUIRE(std::abs(read[axis] / step_mm - std::round(read[axis] / step_mm)) < 1e-9);
        REQUIRE(std::abs(read[axis] - at[axis]) <= 0.5 * step_mm * (1.0 + 1e-9));
      }
    }
  });
}

}  // namespace
}  // namespace touchtrial

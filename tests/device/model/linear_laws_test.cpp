// Laws 6, 8 and 9 of a device in a hand: what is linear of it, a test case each, against transfer
// functions and the theory of sampled walls.
#include "device/model/held_devices.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using device::DeviceDynamics;
using device::DeviceModel;
using device::HandKind;
using device::HandOptions;
using device::HeldDevice;
using Complex = std::complex<double>;
using TipLoad = DeviceDynamics::TipLoad;

/// The linear part of a shipped model.
DeviceModel linear_part(const DeviceModel& model) {
  return unrounded(frictionless(model));
}

/// Published numbers of the grip: N s^2/mm, N/mm and N s/mm.
struct Grip {
  double mass, finger, finger_damper, arm, arm_damper;
};
constexpr std::array<Grip, 3> kGrip{{{0.218e-3, 0.380, 1.84e-3, 0.079, 4.6e-3},
                                     {0.204e-3, 0.770, 0.78e-3, 0.272, 18e-3},
                                     {0.269e-3, 0.552, 3.61e-3, 0.0, 6.4e-3}}};

/// Force per way of a tip in the grip, N/mm, at the complex frequency s.
Complex grip_stiffness(const Grip& g, Complex s) {
  const Complex fingers = g.finger + g.finger_damper * s;
  const Complex behind = g.mass * s * s + g.arm_damper * s + g.arm;
  return 1.0 / (1.0 / fingers + 1.0 / behind);
}

/// Way of the tip per newton that is commanded, by the z-transform. The trapezium rule puts
/// w = (2 / T) (z - 1) / (z + 1) for s, for two positions and the mean of two velocities; a force
/// and the point mass's spring count where the tick begins, implicit dampers where it ends.
double discrete_amplitude_mm(const DeviceModel& model, HandKind hand, std::size_t axis,
                             double frequency_hz) {
  const Complex z = std::polar(1.0, 2.0 * kPi * frequency_hz * kT);
  const Complex w = 2.0 / kT * (z - 1.0) / (z + 1.0);
  const double k_structure = model.structure.stiffness_n_per_mm;
  const bool held = model.zero_order_hold || k_structure > 0.0;
  // Without hold, velocities lie between positions: a mean of three positions takes the place of
  // that of two.
  const Complex begins = held ? 2.0 / (1.0 + z) : 4.0 * z / ((1.0 + z) * (1.0 + z));
  const Complex ends = z * begins * (held ? Complex(1.0) : (1.0 + z) / (2.0 * z));
  const double mass = 0.001 * model.mass_kg;
  Complex at_hand;
  if (hand == HandKind::stylus_grip) {
    at_hand = grip_stiffness(kGrip[axis], w) + std::max(0.0, 0.03e-3 - mass) * w * w;
  } else {
    at_hand = 0.1e-3 * w * w + 0.008 * w * ends + (axis == 2 ? 0.0 : 0.2 * begins);
  }
  Complex motors = std::pow(z, -model.delay_ticks);
  if (model.lowpass_hz > 0.0) {
    const double share = 1.0 - std::exp(-2.0 * kPi * model.lowpass_hz * kT);
    motors *= share * z / (z - (1.0 - share));
  }
  const Complex viscous = 0.001 * model.viscous_n_s_per_m * w * ends;
  if (k_structure == 0.0) {
    return std::abs(motors * begins / (mass * w * w + viscous + at_hand));
  }
  const double tip = model.structure.tip_share * mass;
  const Complex joint =
      k_structure + 2.0 * model.structure.damping_ratio * std::sqrt(k_structure * tip) * w;
  const Complex at_motor = (mass - tip) * w * w + viscous + joint;
  const Complex at_tip = tip * w * w + at_hand + joint;
  return std::abs(motors * begins * joint / (at_motor * at_tip - joint * joint));
}

void require_closed_form(const DeviceModel& model, HandKind hand, double frequency_hz) {
  const auto measured = steady_amplitudes_mm(HeldDevice(hand_by(hand), model), frequency_hz);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    INFO("axis " << axis << " at " << frequency_hz << " Hz");
    CHECK(measured[axis] ==
          Approx(discrete_amplitude_mm(model, hand, axis, frequency_hz)).epsilon(1e-5));
  }
}

TEST_CASE("law 6: the steady amplitude under a sine is that of the discrete transfer function") {
  const double frequency_hz = GENERATE(5.0, 20.0, 45.0, 80.0, 160.0, 320.0, 480.0);
  for_every_device_in_every_hand([=](const DeviceModel& model, const HandOptions& options) {
    require_closed_form(linear_part(model), options.model, frequency_hz);
  });
  // What no shipped model has.
  DeviceModel model = model_of(0.25);
  model.viscous_n_s_per_m = 4.0;
  model.lowpass_hz = 80.0;
  model.delay_ticks = 3;
  const HandKind hand = GENERATE(HandKind::point_mass, HandKind::stylus_grip);
  require_closed_form(model, hand, frequency_hz);
  model.zero_order_hold = true;
  require_closed_form(model, hand, frequency_hz);
  model.structure = {3.5, 0.2, 0.1};
  require_closed_form(model, hand, frequency_hz);
}

TEST_CASE("law 6: well below the servo's rate the steady amplitude is 1 / |k - m w^2 + i w b|") {
  const double frequency_hz = GENERATE(1.0, 5.0, 20.0, 30.0);
  const Complex s(0.0, 2.0 * kPi * frequency_hz);
  DeviceModel model = model_of(0.045);
  model.zero_order_hold = GENERATE(false, true);
  const double pen_mm = 1.0 / std::abs(0.145e-3 * s * s + 0.008 * s + 0.2);
  CHECK(steady_amplitudes_mm(HeldDevice({}, model), frequency_hz)[0] ==
        Approx(pen_mm).epsilon(0.05));
  const HeldDevice held(hand_by(HandKind::stylus_grip), model);
  const auto grip_mm = steady_amplitudes_mm(held, frequency_hz);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Complex all = 0.045e-3 * s * s + grip_stiffness(kGrip[axis], s);
    CHECK(grip_mm[axis] == Approx(1.0 / std::abs(all)).epsilon(0.05));
  }
}

/// The greatest and the least of a motion, over some time.
struct Swing {
  double least = 1e9;
  double greatest = -1e9;
  void see(double value) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
  }
  [[nodiscard]] double size() const { return greatest - least; }
};

/// Pushes on a wall until all is settled or swings, kicks it, and waits.
/// \return the swing in the last 0.4 s over that after the kick
double growth_on_wall(const DeviceModel& model, HandKind hand, double stiffness_n_per_mm) {
  HeldDevice held(hand_by(hand), model);
  constexpr double kPushN = 0.7;
  constexpr int kKick = 5000;
  constexpr int kTicks = 20'000;
  Swing first;
  Swing last;
  for (int i = 0; i < kTicks; ++i) {
    const double depth_mm = std::max(0.0, -held.device.read_position_mm().z);
    const double kick_n = i >= kKick && i < kKick + 5 ? 0.3 : 0.0;
    held.tick({0.0, 0.0, stiffness_n_per_mm * depth_mm}, {}, kPushN - kick_n);
    const double at_mm = held.device.true_position_mm().z;
    if (i >= kKick && i < kKick + 400) first.see(at_mm);
    if (i >= kTicks - 400) last.see(at_mm);
  }
  return last.size() / first.size();
}

/// Nothing but a mass that is heavy enough for the theory, which takes a delay for a slope.
TEST_CASE("law 8: a wall with K (T / 2 + delay) below the damping settles, and above it does not") {
  const double stiffness_n_per_mm = GENERATE(0.2, 0.4, 1.0);
  const int delay_ticks = GENERATE(0, 1, 3);
  const double bound = stiffness_n_per_mm * kT * (0.5 + delay_ticks);  // N s/mm
  INFO(stiffness_n_per_mm << " N/mm, delay of " << delay_ticks << " ticks");
  const auto growth = [&](double damping) {
    DeviceModel model = model_of(0.5);
    model.delay_ticks = delay_ticks;
    model.zero_order_hold = true;
    DeviceDynamics tip(model);
    const TipLoad push{{0.0, 0.0, -0.7}, 0.0, {damping, damping, damping}};
    tip.place({0.0, 0.0, -0.7 / stiffness_n_per_mm});
    for (int i = 0; i < delay_ticks; ++i) tip.tick({0.0, 0.0, 0.7}, push);
    Swing first;
    Swing last;
    for (int i = 0; i < 40'000; ++i) {
      const double kick_n = i == 0 ? 0.5 : 0.0;
      const double depth_mm = std::max(0.0, -tip.read_position_mm().z);
      tip.tick({0.0, 0.0, stiffness_n_per_mm * depth_mm + kick_n}, push);
      if (i < 400) first.see(tip.true_position_mm().z);
      if (i >= 40'000 - 400) last.see(tip.true_position_mm().z);
    }
    return last.size() / first.size();
  };
  CHECK(growth(1.3 * bound) < 0.5);
  CHECK(growth(0.7 * bound) > 1.5);
}

TEST_CASE("law 8: on every held device a wall settles by the device's own damping alone") {
  for_every_device_in_every_hand([](const DeviceModel& shipped, const HandOptions& options) {
    if (!shipped.zero_order_hold) return;
    DeviceModel model = linear_part(shipped);
    const double lag_s = kT * (0.5 + model.delay_ticks);
    const double stiffness_n_per_mm = 0.4;
    model.viscous_n_s_per_m = 1.3 * 1000.0 * stiffness_n_per_mm * lag_s;
    CHECK(growth_on_wall(model, options.model, stiffness_n_per_mm) < 0.02);
    // Half as much again as all dampers of hand and structure together can take.
    model.viscous_n_s_per_m = 0.0;
    const double hand = options.model == HandKind::stylus_grip ? 3.61e-3 : 8e-3;
    const double tip = 0.001 * model.structure.tip_share * model.mass_kg;
    const double joint =
        2.0 * model.structure.damping_ratio * std::sqrt(model.structure.stiffness_n_per_mm * tip);
    CHECK(growth_on_wall(model, options.model, 1.5 * (hand + joint) / lag_s) > 0.5);
  });
}

TEST_CASE("law 9: above the hand's resonance more mass never raises the tip's acceleration") {
  const double frequency_hz = GENERATE(40.0, 63.0, 125.0, 250.0, 320.0);
  const HandKind hand = GENERATE(HandKind::point_mass, HandKind::stylus_grip);
  const bool hold = GENERATE(false, true);
  std::array<double, 3> lighter_mm{1e9, 1e9, 1e9};
  for (const double mass_kg : {0.03, 0.045, 0.08, 0.15, 0.3, 0.6}) {
    DeviceModel model = model_of(mass_kg);
    model.zero_order_hold = hold;
    const auto heavier_mm = steady_amplitudes_mm(HeldDevice(hand_by(hand), model), frequency_hz);
    // The frequency is one, so ways are to each other as accelerations are.
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK(heavier_mm[axis] < lighter_mm[axis]);
    lighter_mm = heavier_mm;
  }
}

}  // namespace
}  // namespace touchtrial

/// \file Devices in hands, for tests of their laws.
#pragma once

#include "core/random.hpp"
#include "device/drivers/simulated/hand_on_tip.hpp"
#include "device/model/device_model.hpp"
#include "support/catch.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace touchtrial {

inline constexpr double kT = 0.001;
inline constexpr double kPi = std::numbers::pi;
inline constexpr std::array kBothHands{device::HandKind::point_mass, device::HandKind::stylus_grip};

inline Vec3 random_vec(RandomStream& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

inline std::array<double, 3> axes_of(Vec3 a) {
  return {a.x, a.y, a.z};
}

inline device::DeviceModel model_of(double mass_kg) {
  device::DeviceModel model;
  model.name = "test";
  model.mass_kg = mass_kg;
  return model;
}

/// Without what rounds, limits or reads: mass, friction, delay, low-pass and structure are left.
inline device::DeviceModel unrounded(device::DeviceModel model) {
  model.force_step_n = model.max_force_n = model.continuous_force_n = 0.0;
  model.position_step_mm = 0.0;
  model.velocity_readings = 0;
  return model;
}

inline device::DeviceModel frictionless(device::DeviceModel model) {
  model.coulomb_n = model.static_n = model.stribeck_mm_s = 0.0;
  return model;
}

inline device::HandOptions hand_by(device::HandKind model) {
  return {.model = model};
}

/// Calls f(model, hand's options) for each shipped model in each hand.
template <typename Function>
void for_every_device_in_every_hand(const Function& f) {
  for (const device::DeviceModel& model : device::shipped_device_models()) {
    for (const device::HandKind hand : kBothHands) {
      INFO(model.name << " in a hand by " << device::name_of(hand));
      f(model, hand_by(hand));
    }
  }
}

/// The steady amplitudes of a tip's position on each axis, mm, under a sine of 1 N on all axes, by
/// correlation over whole periods of multiples of 0.5 Hz.
inline std::array<double, 3> steady_amplitudes_mm(device::HeldDevice held, double frequency_hz) {
  std::array<std::complex<double>, 3> sums{};
  constexpr int kSettled = 20'000;
  constexpr int kCounted = 2000;
  for (int i = 0; i < kSettled + kCounted; ++i) {
    const double phase = 2.0 * kPi * frequency_hz * i * kT;
    if (i >= kSettled) {
      const auto at = axes_of(held.device.true_position_mm());
      for (std::size_t axis = 0; axis < 3; ++axis) sums[axis] += at[axis] * std::polar(1.0, -phase);
    }
    const double push_n = std::sin(phase);
    held.tick({push_n, push_n, push_n}, {}, 0.0);
  }
  const auto amplitude = [](std::complex<double> sum) { return 2.0 * std::abs(sum) / kCounted; };
  return {amplitude(sums[0]), amplitude(sums[1]), amplitude(sums[2])};
}

}  // namespace touchtrial

/// \file A pointer that moves by a script, at the rate of a screen, and a texture to feel with it.
#pragma once

#include "device/drivers/mouse/mouse_device.hpp"
#include "device/servo/servo.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace touchtrial {

/// Publishes the script's state a hundred times per second of the clock's time, and keeps the
/// stylus states.
class ScriptedPointer final : public device::PointerSource {
 public:
  using Script = std::function<device::PointerState(double time_s)>;
  ScriptedPointer(device::ServoClock& clock, Script script)
      : clock_(clock), script_(std::move(script)) {}

  [[nodiscard]] device::PointerState newest() noexcept override {
    const auto round = static_cast<std::uint64_t>(clock_.now().count() / 10'000'000);
    device::PointerState state = script_(static_cast<double>(round) * 0.01);
    if (hangs_after == 0 || round < hangs_after) last_round_ = round;
    state.sequence = last_round_ + 1;
    return state;
  }
  void show(const device::StylusState& stylus) noexcept override { shown = stylus; }

  device::StylusState shown;
  std::uint64_t hangs_after = 0;  ///< rounds; 0: never

 private:
  device::ServoClock& clock_;
  Script script_;
  std::uint64_t last_round_ = 0;
};

/// A wall of 0.4 N/mm; on contact also a tangential force along x that alternates over the plane.
class Grating final : public device::ForceSource {
 public:
  Grating(double wavelength_mm, double amplitude_n)
      : wavenumber_per_mm_(2.0 * std::numbers::pi / wavelength_mm), amplitude_n_(amplitude_n) {}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    if (sample.position_mm.z >= 0.0) return {};
    return {amplitude_n_ * std::sin(wavenumber_per_mm_ * sample.position_mm.x), 0.0,
            -0.4 * sample.position_mm.z};
  }

 private:
  double wavenumber_per_mm_;
  double amplitude_n_;
};

}  // namespace touchtrial

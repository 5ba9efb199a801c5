/// \file A gentle wall in the middle of a device's workspace, to try it with.
#pragma once

#include "device/servo/servo.hpp"

#include <algorithm>
#include <atomic>

namespace touchtrial::app {

/// The plane z = 0, felt from in front (z > 0) alone: switched on behind the stylus' back it waits
/// until the stylus has come out in front of it. It comes and goes within 100 ms.
class TestWall final : public device::ForceSource {
 public:
  static constexpr double kStiffness_n_per_mm = 0.4;
  static constexpr double kMaxForceN = 1.0;

  /// \param rate_hz  of the servo, > 0
  explicit TestWall(double rate_hz) noexcept : share_of_tick_(10.0 / rate_hz) {}

  /// \name Any thread
  ///@{
  void put(bool on) noexcept { on_.store(on, std::memory_order_release); }
  [[nodiscard]] bool is_on() const noexcept { return on_.load(std::memory_order_acquire); }
  /// Whether it is on but waits for the stylus.
  [[nodiscard]] bool waits() const noexcept {
    return is_on() && !met_.load(std::memory_order_acquire);
  }
  ///@}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    const bool on = is_on();
    const double depth_mm = -sample.position_mm.z;
    const bool met = on && (met_.load(std::memory_order_relaxed) || depth_mm <= 0.0);
    // A wall that is switched off goes on to be one while it goes.
    if (met != met_.load(std::memory_order_relaxed)) met_.store(met, std::memory_order_release);
    share_ = std::clamp(share_ + (met ? share_of_tick_ : -share_of_tick_), 0.0, 1.0);
    const double force_n = std::clamp(kStiffness_n_per_mm * depth_mm, 0.0, kMaxForceN);
    return {0.0, 0.0, share_ * force_n};
  }

 private:
  double share_of_tick_;
  double share_ = 0.0;
  std::atomic<bool> on_{false};
  std::atomic<bool> met_{false};
};

}  // namespace touchtrial::app

/// \file Link of the safety chain: motion faster than a hand's.
#pragma once

#include "device/safety/finite_check.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::device {

/// Judges the speed that the device reports, and that by which its position changes: since the last
/// new reading, in the time since it. Readings come from another thread, or over a bus, and two may
/// arrive together; so a change is judged over at least kWindowS, from a reading that old.
class VelocityTrip {
 public:
  static constexpr double kWindowS = 0.001;

  /// \param max_speed_mm_s  > 0; infinity: no limit
  /// \param tick_s  of the servo, > 0
  VelocityTrip(double max_speed_mm_s, double tick_s) noexcept
      : speed_squared_(max_speed_mm_s * max_speed_mm_s),
        change_squared_(speed_squared_ * tick_s * tick_s),
        window_ticks_(std::max(1.0, std::ceil(kWindowS / tick_s - kRounding))) {}

  /// Changes are judged from this reading on.
  void start(const DeviceSample& sample) noexcept {
    from_mm_ = sample.position_mm;
    sequence_ = sample.sequence;
    ticks_ = 0.0;
  }

  /// \param sample  finite
  /// \param ticks  since the last call, >= 1
  [[nodiscard]] bool is_exceeded(const DeviceSample& sample, double ticks) noexcept {
    ticks_ += ticks;
    const double time = std::max(ticks_, window_ticks_);
    const bool exceeded =
        !(squared_norm(sample.velocity_mm_s) <= speed_squared_) ||
        !(squared_norm(sample.position_mm - from_mm_) <= change_squared_ * (time * time));
    const bool is_new = sample.sequence != sequence_;
    sequence_ = sample.sequence;
    if (is_new && ticks_ >= window_ticks_) start(sample);
    return exceeded;
  }

 private:
  static constexpr double kRounding = 1e-6;

  double speed_squared_;   ///< mm^2/s^2
  double change_squared_;  ///< in one tick, mm^2
  double window_ticks_;
  Vec3 from_mm_;
  double ticks_ = 0.0;  ///< since the reading at from_mm_
  std::uint64_t sequence_ = 0;
};

}  // namespace touchtrial::device

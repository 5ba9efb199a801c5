/// \file Link of the safety chain: a device that gives no new readings.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace touchtrial::device {

/// Counts how long a device repeats itself. A device that is slower than the servo repeats a number
/// between its readings; only for stale_s is that a fault.
class Freshness {
 public:
  /// \param stale_s  > 0; infinity: never
  /// \param tick_s  of the servo, > 0
  Freshness(double stale_s, double tick_s) noexcept
      : stale_ticks_(std::max(1.0, std::ceil(stale_s / tick_s - kRounding))),
        most_at_once_(std::max(1.0, 0.5 * stale_ticks_)) {}

  void start(std::uint64_t sequence) noexcept {
    sequence_ = sequence;
    old_ticks_ = 0.0;
  }

  /// \param ticks  since the last call, >= 1. A servo that slept itself sees an old reading first,
  ///   for the device's thread may have slept with it: one look never counts for more than half of
  ///   stale_s.
  [[nodiscard]] bool is_stale(std::uint64_t sequence, double ticks) noexcept {
    if (sequence != sequence_) {
      start(sequence);
      return false;
    }
    old_ticks_ += std::min(ticks, most_at_once_);
    return old_ticks_ >= stale_ticks_;
  }

 private:
  static constexpr double kRounding = 1e-6;  ///< 0.010 / 0.001 is 10 ticks and not 11

  double stale_ticks_;
  double most_at_once_;
  double old_ticks_ = 0.0;
  std::uint64_t sequence_ = 0;
};

}  // namespace touchtrial::device

/// \file The hand's velocity from a Falcon's positions.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <chrono>
#include <cstddef>

namespace touchtrial::device::falcon {

/// The slope of the straight line that fits the newest five positions best, by least squares and
/// the times at which they came.
///
/// One encoder count is about 0.04 mm at the hand: the difference of two readings 1 ms apart moves
/// in steps of 40 mm/s. Over five readings at 1 kHz the line's noise is about 3.5 mm/s rms, and it
/// lags by 2 ms. Nothing here allocates or throws. Not thread-safe.
class VelocityEstimate {
 public:
  using Time = std::chrono::nanoseconds;
  static constexpr std::size_t kReadings = 5;
  /// Readings older than this say nothing of the velocity now.
  static constexpr Time kMemory = std::chrono::milliseconds(50);

  /// \param at  never earlier than the one before
  /// \return mm/s with this position; zero from fewer than two readings
  [[nodiscard]] Vec3 add(Vec3 position_mm, Time at) noexcept;
  /// As before the first reading.
  void forget() noexcept { count_ = 0; }

 private:
  struct Reading {
    Vec3 position_mm;
    Time at{};
  };

  void drop_old(Time now) noexcept;
  [[nodiscard]] Vec3 slope_mm_s() const noexcept;

  std::array<Reading, kReadings> readings_{};  ///< oldest first
  std::size_t count_ = 0;
};

}  // namespace touchtrial::device::falcon

/// \file The hand's velocity from a Falcon's positions.
#pragma once

#include "core/vec.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

namespace touchtrial::device::falcon {

/// The slope of the straight line that fits the newest five positions best, by least squares over
/// the times of their arrival.
///
/// One encoder count is about 0.04 mm at the hand, so the difference of two readings 1 ms apart
/// moves in steps of 40 mm/s. Over five readings at 1 kHz the line's noise is about 3.5 mm/s rms,
/// and its lag 2 ms. Nothing here allocates or throws. Not thread-safe.
class VelocityEstimate {
 public:
  using Time = std::chrono::nanoseconds;
  static constexpr std::size_t kReadings = 5;
  /// The age at which a reading says nothing about the present velocity.
  static constexpr Time kMemory = std::chrono::milliseconds(50);

  /// \param at  never earlier than in the last call
  /// \return the velocity with this position, mm/s; zero from fewer than two readings
  [[nodiscard]] Vec3 add(Vec3 position_mm, Time at) noexcept {
    drop_old(at);
    if (count_ == kReadings) {
      std::move(readings_.begin() + 1, readings_.end(), readings_.begin());
      --count_;
    }
    readings_[count_++] = {position_mm, at};
    return slope_mm_s();
  }
  /// Returns to the state before the first reading.
  void forget() noexcept { count_ = 0; }

 private:
  struct Reading {
    Vec3 position_mm;
    Time at{};
  };

  void drop_old(Time now) noexcept {
    const auto end = readings_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto kept = std::find_if(readings_.begin(), end, [&](const Reading& reading) {
      return now - reading.at <= kMemory;
    });
    std::move(kept, end, readings_.begin());
    count_ = static_cast<std::size_t>(end - kept);
  }
  [[nodiscard]] Vec3 slope_mm_s() const noexcept {
    // Times from the newest reading, so that they stay small and exact.
    const Reading& newest = readings_[count_ - 1];
    double mean_s = 0.0;
    Vec3 mean_mm;
    for (std::size_t i = 0; i < count_; ++i) {
      const double share = 1.0 / static_cast<double>(count_);
      mean_s += share * std::chrono::duration<double>(readings_[i].at - newest.at).count();
      mean_mm = mean_mm + share * (readings_[i].position_mm - newest.position_mm);
    }
    double spread_s2 = 0.0;
    Vec3 product_mm_s;
    for (std::size_t i = 0; i < count_; ++i) {
      const double s = std::chrono::duration<double>(readings_[i].at - newest.at).count() - mean_s;
      spread_s2 += s * s;
      product_mm_s = product_mm_s + s * (readings_[i].position_mm - newest.position_mm - mean_mm);
    }
    return spread_s2 > 0.0 ? (1.0 / spread_s2) * product_mm_s : Vec3{};
  }

  std::array<Reading, kReadings> readings_{};  ///< oldest first
  std::size_t count_ = 0;
};

}  // namespace touchtrial::device::falcon

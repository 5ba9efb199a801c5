/// \file Estimates a hand's velocity from a driver's position readings.
#pragma once

#include "core/vec.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>

namespace touchtrial::device {

/// The slope of the least-squares line through the newest positions, by arrival time.
///
/// The difference of two readings is quantised to encoder steps. The line over n readings at an
/// interval T has a lag of (n - 1) T / 2, and noise of sqrt(12 / (n^3 - n)) times that of one
/// reading, divided by T. Nothing here allocates or throws. Not thread-safe.
/// \tparam kReadings  n, >= 2
template <std::size_t kReadings>
class VelocityEstimate {
 public:
  using Time = std::chrono::nanoseconds;
  /// Readings older than this are ignored.
  static constexpr Time kMemory = std::chrono::milliseconds(50);

  /// \param time  not earlier than in the last call
  /// \return the velocity at this reading, mm/s; zero from fewer than two readings
  [[nodiscard]] Vec3 add(Vec3 position_mm, Time time) noexcept {
    drop_old(time);
    if (count_ == kReadings) {
      std::move(readings_.begin() + 1, readings_.end(), readings_.begin());
      --count_;
    }
    readings_[count_++] = {position_mm, time};
    return slope_mm_s();
  }
  /// Resets to the state before the first reading.
  void reset() noexcept { count_ = 0; }

 private:
  struct Reading {
    Vec3 position_mm;
    Time time{};
  };

  void drop_old(Time now) noexcept {
    const auto end = readings_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto first = std::find_if(readings_.begin(), end, [&](const Reading& reading) {
      return now - reading.time <= kMemory;
    });
    std::move(first, end, readings_.begin());
    count_ = static_cast<std::size_t>(end - first);
  }
  [[nodiscard]] Vec3 slope_mm_s() const noexcept {
    // Times relative to the newest reading, so that they are small and exact.
    const Reading& newest = readings_[count_ - 1];
    double mean_s = 0.0;
    Vec3 mean_mm;
    for (std::size_t i = 0; i < count_; ++i) {
      const double share = 1.0 / static_cast<double>(count_);
      mean_s += share * std::chrono::duration<double>(readings_[i].time - newest.time).count();
      mean_mm = mean_mm + share * (readings_[i].position_mm - newest.position_mm);
    }
    double spread_s2 = 0.0;
    Vec3 product_mm_s;
    for (std::size_t i = 0; i < count_; ++i) {
      const double s =
          std::chrono::duration<double>(readings_[i].time - newest.time).count() - mean_s;
      spread_s2 += s * s;
      product_mm_s = product_mm_s + s * (readings_[i].position_mm - newest.position_mm - mean_mm);
    }
    return spread_s2 > 0.0 ? (1.0 / spread_s2) * product_mm_s : Vec3{};
  }

  std::array<Reading, kReadings> readings_{};  ///< oldest first
  std::size_t count_ = 0;
};

}  // namespace touchtrial::device

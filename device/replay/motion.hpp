/// \file Recorded motion of a hand, tick by tick.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace touchtrial::device {

/// Motion in memory. Its parts are read on the servo thread: no heap, lock or I/O.
class RecordedMotion {
 public:
  /// More ticks than any trial has; what is longer is no recording.
  static constexpr std::int64_t kMostTicks = 4'000'000;

  /// \param rate_hz  > 0, finite
  /// \throws std::invalid_argument if it is not, or there are no positions or too many
  RecordedMotion(std::vector<Vec3> positions_mm, double rate_hz);

  [[nodiscard]] double rate_hz() const noexcept { return rate_hz_; }
  [[nodiscard]] std::int64_t ticks() const noexcept {
    return static_cast<std::int64_t>(positions_mm_.size());
  }
  /// Plane frame. \param tick  0 .. ticks() - 1
  [[nodiscard]] Vec3 position_mm(std::int64_t tick) const noexcept {
    return positions_mm_[static_cast<std::size_t>(tick)];
  }

 private:
  std::vector<Vec3> positions_mm_;
  double rate_hz_;
};

/// Reads a CSV file (RFC 4180, either line end) whose header names time_s, x_mm, y_mm and z_mm, in
/// any order; other columns are left alone. The usual step of time_s gives the rate; where rows are
/// missing the hand moves straight on to the next one.
/// \throws FileError with the line: no such file, column or number, a time that does not increase,
///   a place beyond 10 m, a rate outside 10 to 20,000 Hz, or more than kMostTicks
[[nodiscard]] RecordedMotion read_motion_csv(const std::filesystem::path& file);

}  // namespace touchtrial::device

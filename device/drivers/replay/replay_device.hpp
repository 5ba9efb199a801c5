/// \file Recorded motion of a hand, its CSV file, and a device that replays it regardless of forces.
#pragma once

#include "core/vec.hpp"
#include "device/haptic_device.hpp"

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

namespace touchtrial::device {

/// Positions at every tick, in memory, because the servo thread reads them.
class RecordedMotion {
 public:
  /// A longer motion is refused; no trial has that many ticks.
  static constexpr std::int64_t kMaxTicks = 4'000'000;

  /// \param rate_hz  > 0, finite
  /// \throws std::invalid_argument if the rate is out of range, or there are no positions or too many
  RecordedMotion(std::vector<Vec3> positions_mm, double rate_hz);

  [[nodiscard]] double rate_hz() const noexcept { return rate_hz_; }
  [[nodiscard]] std::int64_t ticks() const noexcept {
    return static_cast<std::int64_t>(positions_mm_.size());
  }
  /// \return the position at a tick, in the plane frame
  /// \param tick  0 .. ticks() - 1
  [[nodiscard]] Vec3 position_mm(std::int64_t tick) const noexcept {
    return positions_mm_[static_cast<std::size_t>(tick)];
  }

 private:
  std::vector<Vec3> positions_mm_;
  double rate_hz_;
};

/// Reads a CSV file (lines end in LF or CRLF, no field has a comma) whose header names time_s,
/// x_mm, y_mm and z_mm in any order, and perhaps other columns. The median step of time_s is one
/// tick; missing rows are interpolated linearly.
/// \throws FileError with the line if the file, a column or a number is missing, a time does not
///   increase, a position is beyond 10 m, the rate is outside 10 to 20,000 Hz, or there are more
///   than kMaxTicks
[[nodiscard]] RecordedMotion read_motion_csv(const std::filesystem::path& file);

/// The driver "replay". Each `write` is one tick, in virtual and in real time; run the servo at the
/// motion's rate. Positions are as recorded, in the plane frame; the velocity is the mean over the
/// last step. Forces have no effect. Not thread-safe.
class ReplayDevice final : public HapticDevice {
 public:
  explicit ReplayDevice(RecordedMotion motion) : motion_(std::move(motion)) {}

  [[nodiscard]] DeviceInfo info() const override;
  /// \return stopped at the end of the motion
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// Does nothing: no force reaches a person.
  void halt() noexcept override {}
  void rearm() noexcept override {}

 private:
  RecordedMotion motion_;
  std::int64_t tick_ = 0;
};

}  // namespace touchtrial::device

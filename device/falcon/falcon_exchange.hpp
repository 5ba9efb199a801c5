/// \file The meaning of a Falcon's replies, and the commands to it: everything between packets and
/// the DeviceLink, without USB, threads or clocks.
#pragma once

#include "core/vec.hpp"
#include "device/device_link.hpp"
#include "device/device_settings.hpp"
#include "device/falcon/falcon_kinematics.hpp"
#include "device/falcon/falcon_packet.hpp"
#include "device/falcon/ftdi_transport.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <optional>

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

/// Belongs to the driver's own thread; the link takes samples to the servo and brings forces.
/// Nothing here allocates, locks or throws.
class FalconExchange final : public FtdiStreamSink {
 public:
  using Time = DeviceLink::Time;

  /// Exchanges in a row without a reply after which forces stop, as their position is too old.
  static constexpr int kForcelessAfter = 2;
  /// ... and after which the device counts as lost.
  static constexpr int kLostAfter = 20;
  /// No hand moves faster: a reply that says so is damaged, unless the next ones agree with it.
  static constexpr double kMostSpeedMmS = 5'000.0;
  static constexpr int kMostJumps = 3;
  /// The time in which the gravity bias rises, so that it does not jerk the hand when a servo
  /// begins.
  static constexpr std::chrono::milliseconds kBiasRamp{500};

  /// \param link  must outlive this
  FalconExchange(const FalconSettings& settings, DeviceLink& link) noexcept;

  /// Bytes from the device, as the transport hands them on.
  void receive(std::span<const std::uint8_t> transfer) noexcept override;
  /// \return whether a reply came since the last `finish`
  [[nodiscard]] bool has_reply() const noexcept { return fresh_; }

  /// Ends one exchange: publishes the newest reply, or counts a missing one. Too many missing ones
  /// fail the link: bad_data if bytes came that make no sense, else link_lost.
  void finish(Time now) noexcept;
  /// \return the packet to send next; it has no force before all axes are homed, and none after
  ///   missing replies
  [[nodiscard]] Packet command(Time now) noexcept;
  /// \return whether all axes are homed, by the newest reply
  [[nodiscard]] bool homed() const noexcept { return homed_; }

  /// \return the last packet of all: lights off, no force
  [[nodiscard]] static Packet farewell() noexcept { return encode_command({}); }

 private:
  void note_missing() noexcept;
  /// \return whether the reply is a possible reading
  [[nodiscard]] bool take(const Reply& reply, Time now) noexcept;
  [[nodiscard]] bool jumps(Vec3 position_mm, Time now) noexcept;
  /// \return the part of the gravity bias that has risen by now
  [[nodiscard]] Vec3 bias_n(Time now) noexcept;
  [[nodiscard]] MotorValues motors(Time now) noexcept;

  DeviceLink& link_;
  Vec3 gravity_bias_n_;
  std::array<int, 3> led_order_;
  std::optional<Time> bias_from_;  ///< when the first force was sent; nothing: there is no force

  FalconStream stream_;
  bool fresh_ = false;
  int missing_ = 0;
  std::uint64_t sense_at_ = 0;  ///< discarded bytes when the last good reply came
  bool bad_reading_ = false;    ///< a reply since then was not a Falcon's reading

  bool homed_ = false;
  bool known_ = false;  ///< whether `pose_` is a reading
  Pose pose_;
  Time pose_at_{};
  int jumps_ = 0;
  VelocityEstimate velocity_;
};

}  // namespace touchtrial::device::falcon

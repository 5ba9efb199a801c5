/// \file The meaning of a Falcon's replies, and the commands to it: everything between packets and
/// the DeviceLink, without USB, threads or clocks.
#pragma once

#include "device/device_link.hpp"
#include "device/device_settings.hpp"
#include "device/falcon/falcon_kinematics.hpp"
#include "device/falcon/falcon_packet.hpp"
#include "device/falcon/ftdi_transport.hpp"
#include "device/falcon/velocity_estimate.hpp"

#include <chrono>
#include <optional>

namespace touchtrial::device::falcon {

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

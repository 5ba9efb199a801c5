/// \file What a Falcon's replies mean and what it is sent: everything between packets and the
/// DeviceLink, without USB, threads or clocks.
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

  /// Exchanges in a row without a reply after which forces are no longer sent: the position that
  /// they belong to is too old.
  static constexpr int kForcelessAfter = 2;
  /// ... and after which the device counts as lost.
  static constexpr int kLostAfter = 20;
  /// A hand does not move faster: a reply that says so is a broken one, unless the next ones agree.
  static constexpr double kMostSpeedMmS = 5'000.0;
  static constexpr int kMostJumps = 3;
  /// In which the gravity bias comes, so that no hand is jerked when a servo begins.
  static constexpr std::chrono::milliseconds kBiasRamp{500};

  /// \param link  must outlive this
  FalconExchange(const FalconSettings& settings, DeviceLink& link) noexcept;

  /// Bytes from the device, as the transport hands them on.
  void receive(std::span<const std::uint8_t> transfer) noexcept override;
  /// Whether a reply came since the last `finish`.
  [[nodiscard]] bool has_reply() const noexcept { return fresh_; }

  /// Ends one exchange: publishes the newest reply, or counts a missing one, and fails the link
  /// where there were too many: bad_data if there were bytes without sense, else link_lost.
  void finish(Time now) noexcept;
  /// What to send next: no force before all axes are homed, or after replies went missing.
  [[nodiscard]] Packet command(Time now) noexcept;
  /// All axes homed, as of the newest reply.
  [[nodiscard]] bool homed() const noexcept { return homed_; }

  /// Lights out, no force: what is sent last.
  [[nodiscard]] static Packet farewell() noexcept { return encode_command({}); }

 private:
  void note_missing() noexcept;
  /// \return whether the reply is a reading that can be
  [[nodiscard]] bool take(const Reply& reply, Time now) noexcept;
  [[nodiscard]] bool jumps(Vec3 position_mm, Time now) noexcept;
  /// What is there of it by now.
  [[nodiscard]] Vec3 bias_n(Time now) noexcept;
  [[nodiscard]] MotorValues motors(Time now) noexcept;

  DeviceLink& link_;
  Vec3 gravity_bias_n_;
  std::array<int, 3> led_order_;
  std::optional<Time> bias_from_;  ///< when forces began to be sent; nothing: none are

  FalconStream stream_;
  bool fresh_ = false;
  int missing_ = 0;
  std::uint64_t sense_at_ = 0;  ///< bytes without sense, when the last good reply came
  bool bad_reading_ = false;    ///< a reply since then was no reading of a Falcon

  bool homed_ = false;
  bool known_ = false;  ///< whether `pose_` is a reading
  Pose pose_;
  Time pose_at_{};
  int jumps_ = 0;
  VelocityEstimate velocity_;
};

}  // namespace touchtrial::device::falcon

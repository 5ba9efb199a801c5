/// \file Interprets a Falcon's replies and makes its commands: everything between packets and the
///   DeviceLink, without USB, threads or clocks.
#pragma once

#include "core/vec.hpp"
#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"
#include "device/drivers/falcon/falcon_kinematics.hpp"
#include "device/drivers/falcon/falcon_motors.hpp"
#include "device/drivers/falcon/falcon_packet.hpp"
#include "device/drivers/falcon/ftdi_transport.hpp"
#include "device/servo/velocity_estimate.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

namespace touchtrial::device::falcon {

/// One encoder count is about 0.04 mm at the hand, so the difference of two readings 1 ms apart
/// moves in steps of 40 mm/s. Over five readings at 1 kHz the line's noise is about 3.5 mm/s rms,
/// and its lag 2 ms.
using VelocityEstimate = device::VelocityEstimate<5>;

/// Belongs to the driver's own thread; the link passes samples to the servo and forces from it.
/// Nothing here allocates, locks or throws.
///
/// An exchange is one command and the reply to it. Replies do not identify their command, so they
/// are counted: a Falcon gives one reply to each command that it gets. A reply that comes after its
/// exchange has ended is still published, but it does not answer the next command.
class FalconExchange final : public FtdiStreamSink {
 public:
  using Time = DeviceLink::Time;

  /// Exchanges in a row without a reply after which forces stop, as their position is too old.
  static constexpr int kForcelessAfter = 2;
  /// ... and after which the device counts as lost.
  static constexpr int kLostAfter = 20;
  /// Exchanges in a row that ended with a reply still due, after which it counts as lost.
  static constexpr int kLostAfterOverdue = 3;
  /// No hand moves faster: such a reply is corrupt, unless the next ones confirm it.
  static constexpr double kMaxSpeedMmS = 5'000.0;
  static constexpr int kMaxJumps = 3;

  /// \param link  must outlive this
  FalconExchange(const FalconSettings& settings, DeviceLink& link) noexcept;

  /// \name From the transport
  ///@{
  void receive(std::span<const std::uint8_t> transfer) noexcept override;
  void sent() noexcept override { ++due_; }
  ///@}

  /// Publishes the newest reply, if one has come since the last call.
  void publish(Time now) noexcept;
  /// Begins an exchange. Call `publish` first, for late replies.
  /// \return the packet to send; it has no force before all axes are homed, and none after missing
  ///   replies
  [[nodiscard]] Packet begin(Time now) noexcept;
  /// \return whether the exchange has a reply, and none is due any more
  [[nodiscard]] bool is_answered() const noexcept { return replied_ && due_ == 0; }
  /// Ends an exchange. Too many in a row without a reading fail the link: bad_data if bytes came
  /// that are not replies, else link_lost.
  void end() noexcept;
  /// \return whether all axes are homed, by the newest reply
  [[nodiscard]] bool homed() const noexcept { return homed_; }

  /// \return a packet with lights off and zero force
  [[nodiscard]] static Packet zero_packet() noexcept { return encode_command({}); }

 private:
  void note_missing() noexcept;
  /// \return whether the reply is a possible reading
  [[nodiscard]] bool take(const Reply& reply, Time now) noexcept;
  [[nodiscard]] bool jumps(Vec3 position_mm, Time now) noexcept;
  [[nodiscard]] PerLeg torques(Time now) noexcept;

  DeviceLink& link_;
  std::array<int, 3> led_order_;
  FalconMotors motors_;
  bool limited_ = false;  ///< the motors could not give the whole force of the last command

  FalconStream stream_;
  int due_ = 0;           ///< outstanding replies to sent commands
  int overdue_ = 0;       ///< exchanges in a row that ended while one was due
  bool fresh_ = false;    ///< a reply is not published yet
  bool replied_ = false;  ///< a reply came since the exchange began
  bool read_ = false;     ///< ... and it was a Falcon's reading
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

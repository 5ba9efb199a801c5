/// \file Converts between a Falcon's packets and the DeviceLink, without USB, threads or clocks.
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

/// One encoder count is about 0.04 mm at the hand, so the velocity from two readings 1 ms apart has
/// steps of 40 mm/s. Over five readings at 1 kHz the noise is about 3.5 mm/s rms, and the lag 2 ms.
using VelocityEstimate = device::VelocityEstimate<5>;

/// Belongs to the driver's thread; the link passes samples to the servo and forces from it. Nothing
/// here allocates, locks or throws.
///
/// An exchange is a command and its reply. Replies do not identify their command, so they are
/// counted: a Falcon sends one reply to each command. A reply that arrives after its exchange has
/// ended is still published, but does not count for the next command.
class FalconExchange final : public FtdiStreamSink {
 public:
  using Time = DeviceLink::Time;

  /// Consecutive exchanges without a reading after which the force is zero, because the position is
  /// too old.
  static constexpr int kForcelessAfter = 2;
  /// Consecutive exchanges without a reading after which the link fails.
  static constexpr int kLostAfter = 20;
  /// Consecutive exchanges with a reply still due after which that reply counts as lost.
  static constexpr int kLostAfterOverdue = 3;
  /// A reply that implies a faster hand is corrupt, unless kMaxJumps further ones confirm it.
  static constexpr double kMaxSpeedMmS = 5'000.0;
  static constexpr int kMaxJumps = 3;

  /// \param link  must outlive this
  FalconExchange(const FalconSettings& settings, DeviceLink& link) noexcept;

  /// \name From the transport
  ///@{
  void receive(std::span<const std::uint8_t> transfer) noexcept override;
  void sent() noexcept override { ++due_replies_; }
  ///@}

  /// Publishes the newest reply, if one has arrived since the last call.
  void publish(Time now) noexcept;
  /// Begins an exchange. Call `publish` first, for late replies.
  /// \return the packet to send; its force is zero before all axes are homed and after missing
  ///   replies
  [[nodiscard]] Packet begin(Time now) noexcept;
  /// \return whether the exchange has a reply and no other reply is due
  [[nodiscard]] bool is_answered() const noexcept { return has_reply_ && due_replies_ == 0; }
  /// Ends an exchange. After kLostAfter exchanges without a reading the link fails: bad_data if
  /// invalid bytes or readings arrived, else link_lost.
  void end() noexcept;
  /// \return whether all axes are homed, by the newest reply
  [[nodiscard]] bool homed() const noexcept { return is_homed_; }

  /// \return a packet with lights off and zero force
  [[nodiscard]] static Packet zero_packet() noexcept { return encode_command({}); }

 private:
  void count_missing_reading() noexcept;
  /// \return whether the reply is a possible reading
  [[nodiscard]] bool accept_reading(const Reply& reply, Time now) noexcept;
  [[nodiscard]] bool reject_jump(Vec3 position_mm, Time now) noexcept;
  [[nodiscard]] PerLeg torques(Time now) noexcept;

  DeviceLink& link_;
  std::array<int, 3> led_order_;
  FalconMotors motors_;
  bool was_limited_ = false;  ///< the motors' limits reduced the last command

  FalconStream stream_;
  int due_replies_ = 0;                     ///< outstanding replies to sent commands
  int overdue_exchanges_ = 0;               ///< consecutive exchanges that ended with a reply due
  bool has_new_reply_ = false;              ///< a reply is not published yet
  bool has_reply_ = false;                  ///< a reply has arrived since the exchange began
  bool has_reading_ = false;                ///< that reply was a valid reading
  int missing_readings_ = 0;                ///< consecutive exchanges without a reading
  std::uint64_t discarded_at_reading_ = 0;  ///< discarded bytes at the last valid reading
  bool has_bad_reading_ = false;            ///< a reply since then was not a valid reading

  bool is_homed_ = false;
  bool has_pose_ = false;  ///< whether `pose_` comes from a homed reading
  Pose pose_;
  Time pose_time_{};
  int jumps_ = 0;
  VelocityEstimate velocity_;
};

}  // namespace touchtrial::device::falcon

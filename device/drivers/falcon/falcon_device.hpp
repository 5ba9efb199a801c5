/// \file The driver "falcon": a Novint Falcon over USB. Tested against an emulator through the
/// unmodified libusb; not verified on hardware.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"
#include "device/drivers/falcon/falcon_exchange.hpp"
#include "device/drivers/falcon/falcon_kinematics.hpp"
#include "device/drivers/falcon/ftdi_transport.hpp"
#include "device/haptic_device.hpp"
#include "device/platform/realtime.hpp"

#include <atomic>
#include <latch>
#include <memory>
#include <thread>

namespace touchtrial::device::falcon {

/// A sphere within the reach of every Falcon.
inline constexpr Workspace kFalconWorkspace = {
    {-kWorkspaceRadiusMm, -kWorkspaceRadiusMm, -kWorkspaceRadiusMm},
    {kWorkspaceRadiusMm, kWorkspaceRadiusMm, kWorkspaceRadiusMm},
    WorkspaceShape::ellipsoid};

/// The clock and sleep of the USB thread.
using FalconPace = LinkPace;

struct FalconOptions {
  std::unique_ptr<FalconPace> pace = std::make_unique<RealLinkPace>();
  /// The USB thread has a slightly higher priority than the servo, which needs its samples.
  SchedulingRequest scheduling{SchedulingPolicy::fifo, 81, true};
};

/// Exchanges one packet each way at up to 1 kHz on a separate thread. Sends no force before all
/// three axes are homed. Its support force is the gravity bias in the settings.
class FalconDevice final : public LinkedDevice {
 public:
  /// The minimum time from one exchange to the next, because the device supports about 1 kHz.
  static constexpr FalconPace::Time kPeriod = std::chrono::milliseconds(1);
  /// The time limit for a reply, after which the next command is sent. Two bus frames, the chip's
  /// latency of 1 ms and 0.1 ms of transfer each way add up to at most 3.2 ms. With this limit, two
  /// lost replies in a row take less than the safety chain's 10 ms without a reading.
  static constexpr FalconPace::Time kReplyLimit = std::chrono::milliseconds(3);
  /// Zero-force packets sent before the device is closed.
  static constexpr int kFinalPackets = 5;
  /// The time limit for each of them.
  static constexpr std::chrono::milliseconds kFinalLimit{20};

  /// Loads the firmware unless it is already running; returns once exchanges have begun.
  /// \throws DeviceError or FileError with the remedy
  FalconDevice(std::unique_ptr<FtdiTransport> transport, const FalconSettings& settings,
               FalconOptions options = {});
  ~FalconDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] Vec3 support_force_n(const DeviceSample& /*sample*/) noexcept override {
    return settings_.gravity_bias_n;
  }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

  /// The scheduling that the USB thread obtained.
  [[nodiscard]] const SchedulingObtained& scheduling() const noexcept { return scheduling_; }

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override { return link_; }
  [[nodiscard]] DeviceLink::Time link_time() const noexcept override {
    return options_.pace->now();
  }
  void exchange_until_stopped() noexcept;
  void exchange() noexcept;
  void wait_for_reply() noexcept;
  void send_final_zeros() noexcept;

  FalconSettings settings_;
  std::unique_ptr<FtdiTransport> transport_;
  FalconOptions options_;
  mutable DeviceLink link_;
  FalconExchange exchange_;
  std::atomic<bool> homed_{false};
  std::atomic<bool> stopping_{false};
  SchedulingObtained scheduling_;
  std::latch started_{1};  ///< open once `scheduling_` is set
  std::thread thread_;
};

/// Sends zero force.
/// \return whether loaded firmware answers
/// \throws DeviceError if the device was disconnected
[[nodiscard]] bool probe_falcon(FtdiTransport& transport);

}  // namespace touchtrial::device::falcon

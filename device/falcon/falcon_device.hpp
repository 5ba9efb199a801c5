/// \file The driver "falcon": a Novint Falcon over USB. Tested against an emulator through the
/// unmodified libusb; not verified on hardware.
#pragma once

#include "device/device_link.hpp"
#include "device/device_settings.hpp"
#include "device/falcon/falcon_exchange.hpp"
#include "device/falcon/falcon_kinematics.hpp"
#include "device/falcon/ftdi_transport.hpp"
#include "device/haptic_device.hpp"
#include "device/platform/realtime.hpp"

#include <atomic>
#include <latch>
#include <memory>
#include <thread>

namespace touchtrial::device::falcon {

/// The ball that every Falcon reaches.
inline constexpr Workspace kFalconWorkspace = {
    {-kWorkspaceRadiusMm, -kWorkspaceRadiusMm, -kWorkspaceRadiusMm},
    {kWorkspaceRadiusMm, kWorkspaceRadiusMm, kWorkspaceRadiusMm},
    WorkspaceShape::ellipsoid};

/// Time and rest of the USB thread, so that tests own them.
class FalconPace {
 public:
  using Time = DeviceLink::Time;
  virtual ~FalconPace() = default;
  /// The monotonic time. May be called from any thread.
  [[nodiscard]] virtual Time now() noexcept = 0;
  /// The USB thread rests here until its next exchange is due.
  virtual void rest_until(Time time) noexcept = 0;
  /// Ends the rest for good: the device is being closed, or the USB thread has ended. May be called
  /// from any thread.
  virtual void end() noexcept {}
};

/// Real time.
[[nodiscard]] std::unique_ptr<FalconPace> real_falcon_pace();

struct FalconOptions {
  std::unique_ptr<FalconPace> pace = real_falcon_pace();
  /// Of the USB thread: its priority is a little above that of the servo, which needs its samples.
  SchedulingRequest scheduling{SchedulingPolicy::fifo, 81, true};
};

/// Exchanges one packet each way at up to 1 kHz on a thread of its own. Sends no force before all
/// three axes are homed; adds the gravity bias while a servo runs.
class FalconDevice final : public HapticDevice {
 public:
  /// The shortest time from one exchange to the next: the device manages about 1 kHz.
  static constexpr FalconPace::Time kPeriod = std::chrono::milliseconds(1);
  /// The longest time for a reply.
  static constexpr FalconPace::Time kReplyLimit = std::chrono::milliseconds(5);
  /// Packets without force before the device is closed.
  static constexpr int kFarewells = 5;

  /// Loads the firmware unless the device answers already; returns once exchanges have begun.
  /// \throws DeviceError or FileError with the remedy
  FalconDevice(std::unique_ptr<FtdiTransport> transport, const FalconSettings& settings,
               FalconOptions options = {});
  ~FalconDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  void halt() noexcept override { link_.halt(); }
  void rearm() noexcept override { link_.rearm(); }
  [[nodiscard]] DeviceFault fault() const noexcept override { return link_.fault(); }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

  /// The scheduling that the USB thread obtained.
  [[nodiscard]] const SchedulingObtained& scheduling() const noexcept { return scheduling_; }

 private:
  void exchange_until_stopped() noexcept;
  void exchange() noexcept;
  void say_farewell() noexcept;

  std::unique_ptr<FtdiTransport> transport_;
  FalconOptions options_;
  DeviceLink link_;
  FalconExchange exchange_;
  std::atomic<bool> homed_{false};
  std::atomic<bool> stopping_{false};
  SchedulingObtained scheduling_;
  std::latch started_{1};  ///< until its scheduling is known
  std::thread thread_;
};

/// Moves nothing.
/// \return whether loaded firmware answers
/// \throws DeviceError if the device is gone
[[nodiscard]] bool falcon_answers(FtdiTransport& transport);

}  // namespace touchtrial::device::falcon

/// \file Force Dimension's omega, delta and sigma, through the vendor's library.
#pragma once

#include "device/device_settings.hpp"
#include "device/haptic_device.hpp"

#include <memory>

namespace touchtrial::device {

/// The driver "dhd". A thread of its own polls the device at 4 kHz; its velocity threshold and
/// watchdog stay on beneath our safety chain, its time guard is set, gravity compensation and the
/// effector's mass are as the settings say. Not verified on hardware.
///
/// No force is sent before the device knows where its axes are; samples are not ready either while
/// somebody has switched force off at the device. A fault latches: a device that failed has to be
/// opened anew.
class DhdDevice final : public HapticDevice {
 public:
  /// \throws DeviceError with the remedy: no library, not all of its functions, no such device, or
  ///   a setting that it refuses
  explicit DhdDevice(const DhdSettings& settings);
  /// Zero force, then force off, then the device is closed.
  ~DhdDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  void halt() noexcept override;
  void rearm() noexcept override;
  [[nodiscard]] DeviceFault fault() const noexcept override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace touchtrial::device

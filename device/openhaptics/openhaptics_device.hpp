/// \file 3D Systems Touch, Phantom Omni and their kin, through the vendor's library.
#pragma once

#include "device/device_settings.hpp"
#include "device/haptic_device.hpp"

#include <memory>

namespace touchtrial::device {

/// The driver "openhaptics". The library's frame is the device frame: x to the right, y up, z
/// towards the person, mm. Forces go out from the library's own scheduler thread; its clamping and
/// ramping stay on beneath our safety chain. Not verified on hardware.
///
/// Until the device says that it is calibrated no force is sent; when it wants its calibration
/// brought up to date (the stylus is in the inkwell), that is done. A fault latches: a device that
/// failed has to be opened anew.
class OpenHapticsDevice final : public HapticDevice {
 public:
  /// Starts the scheduler; samples come from then on. One at a time in a process.
  /// \throws DeviceError with the remedy: no library, not all of its functions, no device, one that
  ///   is open already, or a rate that the scheduler refuses
  explicit OpenHapticsDevice(const OpenHapticsSettings& settings);
  /// Zero force, then the scheduler stops, then everything is let go of.
  ~OpenHapticsDevice() override;

  [[nodiscard]] DeviceInfo info() const override { return info_; }
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  void halt() noexcept override;
  void rearm() noexcept override;
  [[nodiscard]] DeviceFault fault() const noexcept override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

 private:
  class Running;
  DeviceInfo info_;
  std::unique_ptr<Running> running_;
};

}  // namespace touchtrial::device

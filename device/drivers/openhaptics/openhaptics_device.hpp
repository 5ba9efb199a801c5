/// \file 3D Systems Touch, Phantom Omni and similar devices, through the vendor's library.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"

#include <memory>

namespace touchtrial::device {

/// The driver "openhaptics". The library's frame is the device frame: x to the right, y up, z
/// towards the person, mm. The library's scheduler thread sends the forces; its clamping and
/// ramping stay active in addition to the safety chain. Not verified on hardware.
///
/// The driver sends no force before the device reports that it is calibrated. It updates the
/// calibration when the device requests it (it was moved, or the stylus is in the inkwell) and no
/// servo writes forces, or when `calibrate` confirms the arm's reset position. A fault latches
/// until the device is reopened.
class OpenHapticsDevice final : public LinkedDevice {
 public:
  /// Starts the scheduler, which delivers samples. A process may have one device at a time.
  /// \throws DeviceError with the remedy if the library or one of its functions is missing, no
  ///   device is found, one is already open, or the scheduler refuses the rate
  explicit OpenHapticsDevice(const OpenHapticsSettings& settings);
  /// Sends zero force, stops the scheduler, and closes the device.
  ~OpenHapticsDevice() override;

  [[nodiscard]] DeviceInfo info() const override { return info_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;
  void calibrate() noexcept override;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;

  class Runtime;
  DeviceInfo info_;
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace touchtrial::device

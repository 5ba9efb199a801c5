/// \file 3D Systems Touch, Phantom Omni and similar devices, through the vendor's library.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"

#include <memory>

namespace touchtrial::device {

/// The driver "openhaptics". The library's frame is the device frame: x to the right, y up, z
/// towards the person, mm. The library's own scheduler thread sends the forces; its clamping and
/// ramping stay active below our safety chain. Not verified on hardware.
///
/// The driver sends no force before the device reports that it is calibrated. It updates the
/// calibration when the device requests it and no servo writes forces (the device was moved, or the
/// stylus lies in the inkwell), or when `calibrate` confirms the arm's reset position. A fault
/// latches: reopen the device.
class OpenHapticsDevice final : public LinkedDevice {
 public:
  /// Starts the scheduler, which delivers samples. A process may have one device at a time.
  /// \throws DeviceError with the remedy if there is no library, a function of it is missing, there
  ///   is no device, one is open already, or the scheduler refuses the rate
  explicit OpenHapticsDevice(const OpenHapticsSettings& settings);
  /// Sends zero force, stops the scheduler, and closes the device.
  ~OpenHapticsDevice() override;

  [[nodiscard]] DeviceInfo info() const override { return info_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;
  void calibrate() noexcept override;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;

  class Running;
  DeviceInfo info_;
  std::unique_ptr<Running> running_;
};

}  // namespace touchtrial::device

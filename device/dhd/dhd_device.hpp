/// \file Force Dimension's omega, delta and sigma, through the vendor's library.
#pragma once

#include "device/device_link.hpp"
#include "device/device_settings.hpp"

#include <memory>

namespace touchtrial::device {

/// The driver "dhd". A thread of its own polls the device at 4 kHz. The device's velocity threshold
/// and watchdog stay on beneath our safety chain; its time guard is set; gravity compensation and
/// the effector's mass follow the settings. Not verified on hardware.
///
/// The driver sends no force before the device knows where its axes are. Samples are not ready
/// while a person has switched force off at the device. A fault latches: open the device anew.
class DhdDevice final : public LinkedDevice {
 public:
  /// \throws DeviceError with the remedy if there is no library, a function of it is missing, there
  ///   is no such device, or it refuses a setting
  explicit DhdDevice(const DhdSettings& settings);
  /// Sends zero force, switches force off, and closes the device.
  ~DhdDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;

  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace touchtrial::device

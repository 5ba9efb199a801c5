/// \file Force Dimension's omega, delta, sigma and lambda, through the vendor's library.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"

#include <chrono>
#include <limits>
#include <memory>

namespace touchtrial::device {

/// The driver "dhd". A separate thread polls the device at 4 kHz. The device's velocity threshold
/// stays active in addition to the safety chain. The driver sets the device's time guard and
/// watchdog (10 ms), and the library's force limit. Not verified on hardware.
///
/// Force is off, with the brakes on, before the device is calibrated and after a halt or a fault.
/// While force is on, the library adds the weight of arms and end-effector to every force, even
/// zero; force is not switched on if this weight is implausible. Samples are not ready while a
/// person has switched force off at the device. A fault latches until the device is reopened.
class DhdDevice final : public LinkedDevice {
 public:
  /// \param limit_n  > 0; after the safety chain, the library enforces this limit or the device's
  ///   maximum, plus the model's largest possible weight
  /// \param now  the clock of readings, for velocities; tests may replace it
  /// \throws DeviceError with the remedy if the library or one of its functions is missing, there is
  ///   no such device, it refuses a setting, or a setting is implausible
  explicit DhdDevice(const DhdSettings& settings,
                     double limit_n = std::numeric_limits<double>::infinity(),
                     std::chrono::nanoseconds (*now)() = monotonic_now);
  /// Sends zero force, switches force off, restores settings, and closes the device.
  ~DhdDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;

  struct Runtime;
  std::unique_ptr<Runtime> runtime_;
};

}  // namespace touchtrial::device

/// \file Force Dimension's omega, delta, sigma and lambda, through the vendor's library.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"

#include <chrono>
#include <limits>
#include <memory>

namespace touchtrial::device {

/// The driver "dhd". A thread of its own polls the device at 4 kHz. The device's velocity threshold
/// stays active below our safety chain. The driver sets its time guard, its watchdog (10 ms), and
/// the library's force limit (the device's maximum). Not verified on hardware.
///
/// Force is off, with the brakes on, before the device is calibrated and after a halt or a fault.
/// While force is on, the library adds the weight of arms and end-effector to every force, even
/// zero; an implausible weight is refused before that. Samples are not ready while a person has
/// switched force off at the device. A fault latches: reopen the device.
class DhdDevice final : public LinkedDevice {
 public:
  /// \param limit_n  > 0; after the safety chain, the library enforces this limit or the device's
  ///   maximum, plus the model's largest possible weight
  /// \param now  the clock of readings, for velocities; tests may replace it
  /// \throws DeviceError with the remedy if there is no library, a function of it is missing, there
  ///   is no such device, it refuses a setting, or a setting is implausible
  explicit DhdDevice(const DhdSettings& settings,
                     double limit_n = std::numeric_limits<double>::infinity(),
                     std::chrono::nanoseconds (*now)() = monotonic_now);
  /// Sends zero force, switches force off, restores settings, and closes the device.
  ~DhdDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;

  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace touchtrial::device

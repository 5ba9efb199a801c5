/// \file Force Dimension's omega, delta, sigma and lambda, through the vendor's library.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"

#include <chrono>
#include <limits>
#include <memory>

namespace touchtrial::device {

/// The driver "dhd". A thread of its own polls the device at 4 kHz. The device's velocity threshold
/// stays on beneath our safety chain; its time guard is set, its watchdog to 10 ms, and the
/// library's own limit of force to the device's largest. Not verified on hardware.
///
/// Force is off, with the brakes on, before the device is calibrated and after a halt or a fault.
/// While force is on, the library adds the weight of arms and end-effector to every force, also to
/// none; an implausible weight is refused before. Samples are not ready while a person has switched
/// force off at the device. A fault latches: open the device anew.
class DhdDevice final : public LinkedDevice {
 public:
  /// \param limit_n  > 0; behind the safety chain the library holds this limit, or the device's
  ///   largest force, and beyond it the most that the model can weigh
  /// \param now  the time of a reading, for velocities; a test may have another one
  /// \throws DeviceError with the remedy if there is no library, a function of it is missing, there
  ///   is no such device, it refuses a setting, or a setting cannot be true
  explicit DhdDevice(const DhdSettings& settings,
                     double limit_n = std::numeric_limits<double>::infinity(),
                     std::chrono::nanoseconds (*now)() = monotonic_now);
  /// Sends zero force, switches force off, puts back what was set, and closes the device.
  ~DhdDevice() override;

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceReadiness readiness() const noexcept override;

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override;

  struct Running;
  std::unique_ptr<Running> running_;
};

}  // namespace touchtrial::device

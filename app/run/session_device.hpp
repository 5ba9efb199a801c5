/// \file The device of a session with a person: its choice, placement of the plane, acceptance, and
///   consent to force.
#pragma once

#include "app/run/run_session.hpp"
#include "core/plane_geometry.hpp"
#include "device/acceptance/certificate.hpp"
#include "device/device_settings.hpp"
#include "device/drivers/mouse/pointer_exchange.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/servo_clock.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/experimenter.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Whether a session may run with this scheduling of its servo. A servo without real-time
/// scheduling is late by tens of milliseconds, during which the force does not change.
/// \param is_late_allowed  whether the experimenter allows a late servo
/// \return the entry for the session's record; nothing if the servo is punctual, or no force is
///   felt
/// \throws DeviceError with the lines that enable real-time scheduling, if force would be felt
[[nodiscard]] std::optional<session::ExperimenterRequest> lateness_entry(
    const device::DeviceInfo& device, const device::SchedulingObtained& scheduling,
    bool is_late_allowed);

/// The device of a session. The constructor opens it, so that its properties are known before the
/// session is opened. Construct it on the main thread; then it belongs to the session's thread.
class SessionDevice {
 public:
  /// \param attendant  asked for consent to force, except for the mouse, which has none
  /// \throws UsageError if no device is named and not exactly one is plugged in
  /// \throws DeviceError with the remedy if the device cannot be opened, if its workspace does not
  ///   contain the plane, or if a force-feedback device has no valid certificate and the options do
  ///   not allow that; also as lateness_entry
  /// \throws as read_certificate
  SessionDevice(const RunOptions& options, const PlaneGeometry& plane,
                session::Attendant& attendant);

  [[nodiscard]] session::DeviceStation& station() noexcept { return *station_; }
  /// The device in the plane's frame, once the station is ready.
  [[nodiscard]] device::HapticDevice& device() { return station_->device(); }
  [[nodiscard]] const device::DeviceInfo& info() const noexcept { return info_; }
  [[nodiscard]] const std::string& driver() const noexcept { return driver_; }
  [[nodiscard]] const device::InstrumentSettings& instruments() const noexcept {
    return settings_.instruments;
  }
  /// The lab's limits, reduced if the device delivers more force than commanded.
  [[nodiscard]] device::LabLimits limits() const;
  /// \throws DeviceError as device::require_stable, if there is a certificate
  void require_stable_wall(double stiffness_n_per_mm) const;
  /// The driver's name, stamped if there is no valid certificate.
  [[nodiscard]] std::string display_name() const;
  /// The value of StationRecord::calibration.
  [[nodiscard]] const std::string& certificate() const noexcept { return certificate_; }
  /// Entries about the device for the session's record.
  [[nodiscard]] const std::vector<session::ExperimenterRequest>& record_entries() const noexcept {
    return record_entries_;
  }
  /// The mouse device's exchange with the window; null for other devices.
  [[nodiscard]] device::PointerExchange* pointer() noexcept {
    return info_.visual ? &pointer_ : nullptr;
  }

 private:
  /// Consents at once, for a device without force.
  class Consent final : public session::Attendant {
   public:
    [[nodiscard]] Reply poll(const std::string& need) override;
  };

  [[nodiscard]] std::unique_ptr<device::HapticDevice> open();
  void check_certificate(const RunOptions& options);
  [[nodiscard]] std::string load_certificate(const RunOptions& options);

  device::DeviceSettings settings_;
  std::string driver_;
  device::PointerExchange pointer_;
  device::PacedClock pointer_clock_{device::PacedClock::Time{}};
  Consent consent_;
  std::unique_ptr<device::HapticDevice>
      opened_device_;  ///< the open device, until it is moved into the station
  device::DeviceInfo info_;
  std::string certificate_;
  std::optional<device::Certificate> acceptance_;
  std::vector<session::ExperimenterRequest> record_entries_;
  std::optional<session::DeviceStation> station_;
};

}  // namespace touchtrial::app

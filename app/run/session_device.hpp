/// \file The device of a session with a person: which one, where the plane lies on it, how it is
/// calibrated, and who lets its force on.
#pragma once

#include "app/run/run_options.hpp"
#include "core/plane_geometry.hpp"
#include "device/device_settings.hpp"
#include "device/mouse/pointer_exchange.hpp"
#include "device/servo/paced_clock.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/experimenter.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Opened when it is made, so that whoever opens the session knows what the hand will be on.
/// Made on the main thread; then it belongs to the session's.
class SessionDevice {
 public:
  /// \param attendant  asked for consent to force, but for the mouse, which has none
  /// \throws UsageError if no device is named and not exactly one is plugged in; DeviceError with
  ///   the remedy if it cannot be opened, its room does not hold the plane, or its certificate does
  ///   not hold; as read_certificate
  SessionDevice(const RunOptions& options, const PlaneGeometry& plane,
                session::Attendant& attendant);

  [[nodiscard]] session::DeviceStation& station() noexcept { return *station_; }
  /// In the plane frame, once the station is ready.
  [[nodiscard]] device::HapticDevice& device() { return station_->device(); }
  [[nodiscard]] const device::DeviceInfo& info() const noexcept { return info_; }
  [[nodiscard]] const std::string& driver() const noexcept { return driver_; }
  [[nodiscard]] device::LabLimits limits() const { return settings_.use_of(driver_).limits; }
  /// SHA-256 of the certificate, hexadecimal; empty: there is none.
  [[nodiscard]] const std::string& certificate() const noexcept { return certificate_; }
  /// What the session's record is to say of the device, each once.
  [[nodiscard]] const std::vector<session::ExperimenterRequest>& to_record() const noexcept {
    return to_record_;
  }
  /// Of the device "mouse": the window's; null for all others.
  [[nodiscard]] device::PointerExchange* pointer() noexcept {
    return info_.visual ? &pointer_ : nullptr;
  }

 private:
  /// There is no force that anybody would have to consent to.
  class Consent final : public session::Attendant {
   public:
    [[nodiscard]] Says attend(const std::string& need) override;
  };

  [[nodiscard]] std::unique_ptr<device::HapticDevice> open();
  void look_at_certificate(const RunOptions& options);

  device::DeviceSettings settings_;
  std::string driver_;
  device::PointerExchange pointer_;
  device::PacedClock pointer_clock_{device::PacedClock::Time{}};
  Consent consent_;
  std::unique_ptr<device::HapticDevice> first_;  ///< until the station takes it
  device::DeviceInfo info_;
  std::string certificate_;
  std::vector<session::ExperimenterRequest> to_record_;
  std::optional<session::DeviceStation> station_;
};

}  // namespace touchtrial::app

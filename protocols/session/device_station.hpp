/// \file Supplies a session with its device, and reopens the device after a fault. A person must
/// consent before the device is armed.
#pragma once

#include "device/haptic_device.hpp"
#include "device/platform/realtime.hpp"
#include "device/servo/placed_device.hpp"
#include "record/session_bodies.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::session {

enum class SupplyState {
  ready,    ///< the device is open, homed and armed: forces may be sent
  not_yet,  ///< a condition is missing; call again
  stopped,  ///< a person gave up waiting; the session must end
};

/// Provides the device. Used only between explorations, on the session's thread.
class DeviceSupply {
 public:
  virtual ~DeviceSupply() = default;

  /// Performs one step towards a ready device: opens it if it was lost, waits for its homing, or
  /// asks for consent to arm it. May block briefly.
  [[nodiscard]] virtual SupplyState make_ready() = 0;
  /// Called after an interrupted exploration. No force may be sent before a person consents.
  virtual void on_interruption() {}
};

/// Supplies a device that is always ready: a simulated hand, created for each exploration.
class AlwaysReady final : public DeviceSupply {
 public:
  [[nodiscard]] SupplyState make_ready() override { return SupplyState::ready; }
};

/// The person who attends to the device while a session waits for it.
class Attendant {
 public:
  virtual ~Attendant() = default;
  enum class Reply {
    wait,
    arm,
    stop,
    at_reset,  ///< the arm is at its reset position: HapticDevice::calibrate
  };
  /// Called repeatedly. May block briefly, for instance to draw a screen.
  /// \param condition  the missing condition and its remedy, in one line; if it is empty, nothing
  ///   is missing, and force may be switched on when the hand is ready
  /// \return the reply; `arm` has no effect while a condition is missing
  [[nodiscard]] virtual Reply poll(const std::string& condition) = 0;
};

/// Opens the session's device, and reopens it after it was lost. Force is never switched on
/// automatically: the attendant must consent at the start and after every interruption.
class DeviceStation final : public DeviceSupply {
 public:
  /// Opens the device.
  /// \throws DeviceError, or FileError for its firmware, with the remedy
  using Open = std::function<std::unique_ptr<device::HapticDevice>()>;

  /// \param placement  empty for a device that uses the plane frame
  /// \param attendant  must outlive this
  DeviceStation(Open open, const std::optional<device::PlanePlacement>& placement,
                Attendant& attendant);

  /// Refuses a device whose name or serial differs from the first one's. Also returns `stopped`
  /// after a signal that requested the program's end during an exploration.
  [[nodiscard]] SupplyState make_ready() override;
  void on_interruption() override { armed_ = false; }

  /// The device, in the plane frame; valid until the next `make_ready`.
  /// \throws std::logic_error if no device is open
  [[nodiscard]] device::HapticDevice& device();
  /// Describes the first device.
  /// \throws std::logic_error if no device has been opened
  [[nodiscard]] const device::DeviceInfo& info() const;

 private:
  /// \return the missing condition; empty if there is none
  [[nodiscard]] std::string missing_condition();
  /// \return why the device cannot be opened; empty if it is open
  [[nodiscard]] std::string open();
  void close() noexcept;

  Open open_;
  std::optional<device::PlanePlacement> placement_;
  Attendant& attendant_;
  std::unique_ptr<device::HapticDevice> device_;
  std::optional<device::PlacedDevice> placed_device_;
  std::optional<device::DeviceInfo> first_info_;
  bool armed_ = false;
};

/// Fills in the device and servo thread of a session's first event.
/// \param certificate  as StationRecord::calibration
void describe_station(record::SessionOpening& opening, const device::DeviceInfo& device,
                      const device::SchedulingObtained& scheduling, double rate_hz,
                      const std::string& certificate);

}  // namespace touchtrial::session

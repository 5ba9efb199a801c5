/// \file Supplies a session with its device, and recovers it after a fault. A real device is opened,
/// placed, armed with a person's consent, and reopened.
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
  ready,    ///< open, homed and armed: forces may be sent
  not_yet,  ///< something is missing; call again
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
  virtual void interrupted() {}
};

/// For a device that is always ready: a simulated hand, created for each exploration.
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
  /// \param need  one line on what is missing, with its remedy; empty if nothing is missing, so that
  ///   force may be switched on when the hand is ready
  /// \return the reply; `arm` has no effect while something is missing
  [[nodiscard]] virtual Reply attend(const std::string& need) = 0;
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

  /// Refuses a device with another name or serial than the first one. Also returns `stopped` once a
  /// signal has asked the program to end during an exploration.
  [[nodiscard]] SupplyState make_ready() override;
  void interrupted() override { armed_ = false; }

  /// The device, in the plane frame; valid until the next `make_ready`.
  /// \throws std::logic_error if none is open
  [[nodiscard]] device::HapticDevice& device();
  /// Describes the first device.
  /// \throws std::logic_error if none has been opened
  [[nodiscard]] const device::DeviceInfo& info() const;

 private:
  /// \return what is missing; empty if nothing is
  [[nodiscard]] std::string missing();
  /// \return why the device cannot be opened; empty if it is open
  [[nodiscard]] std::string open();
  void close() noexcept;

  Open open_;
  std::optional<device::PlanePlacement> placement_;
  Attendant& attendant_;
  std::unique_ptr<device::HapticDevice> device_;
  std::optional<device::PlacedDevice> placed_;
  std::optional<device::DeviceInfo> first_;
  bool armed_ = false;
};

/// Fills in the device and servo thread of a session's first event.
/// \param certificate  as StationRecord::calibration
void describe_station(record::SessionOpening& opening, const device::DeviceInfo& device,
                      const device::SchedulingObtained& scheduling, double rate_hz,
                      const std::string& certificate);

}  // namespace touchtrial::session

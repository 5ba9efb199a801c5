/// \file A real device as a session has it: opened, placed, armed by consent, and opened again.
#pragma once

#include "device/haptic_device.hpp"
#include "device/placed_device.hpp"
#include "device/platform/realtime.hpp"
#include "protocols/session/device_supply.hpp"
#include "protocols/store/payload.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::session {

/// Who is asked while a session waits for its device.
class Attendant {
 public:
  virtual ~Attendant() = default;
  enum class Says { wait, arm, stop };
  /// Called over and over. \param need  a line on what is missing and its remedy; empty: all is
  ///   there, and force may come on if the hand is ready for it. \return `arm` counts only then.
  ///   May block for a moment, as a screen does that draws
  [[nodiscard]] virtual Says attend(const std::string& need) = 0;
};

/// Opens the session's device, and opens it anew after it was lost. Force never comes on by itself:
/// at the beginning and after every interruption the attendant has to say so.
class DeviceStation final : public DeviceSupply {
 public:
  /// Opens the device; throws DeviceError, or FileError for its firmware, with the remedy if it
  /// cannot.
  using Open = std::function<std::unique_ptr<device::HapticDevice>()>;

  /// \param placement  nothing for a device that speaks the plane frame
  /// \param attendant  must outlive this
  DeviceStation(Open open, const std::optional<device::PlanePlacement>& placement,
                Attendant& attendant);

  /// A device other than the one that was there first (name or serial) is not taken. Stopped, too,
  /// once a signal has asked the program to end during an exploration.
  [[nodiscard]] SupplyState make_ready() override;
  void interrupted() override { armed_ = false; }

  /// In the plane frame; until the next `make_ready`. \throws std::logic_error if none is open
  [[nodiscard]] device::HapticDevice& device();
  /// Of the device that was there first. \throws std::logic_error if none was
  [[nodiscard]] const device::DeviceInfo& info() const;

 private:
  /// \return what is missing; empty if nothing is
  [[nodiscard]] std::string missing();
  [[nodiscard]] std::string open_again();
  void close() noexcept;

  Open open_;
  std::optional<device::PlanePlacement> placement_;
  Attendant& attendant_;
  std::unique_ptr<device::HapticDevice> device_;
  std::optional<device::PlacedDevice> placed_;
  std::optional<device::DeviceInfo> first_;
  bool armed_ = false;
};

/// What a session's first event says of its device and servo thread.
/// \param certificate  SHA-256 of the device's calibration certificate, hexadecimal, or empty
void describe_station(store::SessionOpening& opening, const device::DeviceInfo& device,
                      const device::SchedulingObtained& scheduling, double rate_hz,
                      const std::string& certificate);

}  // namespace touchtrial::session

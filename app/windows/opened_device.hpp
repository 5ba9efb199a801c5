/// \file A device opened by its name for a person, with the window that it may need.
#pragma once

#include "app/windows/pointer_window.hpp"
#include "device/device_settings.hpp"
#include "device/haptic_device.hpp"
#include "device/mouse/mouse_device.hpp"
#include "device/servo/paced_clock.hpp"

#include <memory>
#include <string>

namespace touchtrial::app {

/// Every driver of the registry; "mouse" with a PointerWindow. Belongs to the main thread, which
/// must call `attend` again and again while a servo runs the device on another: a window that
/// nobody attends to is a hand that lets go.
class OpenedDevice {
 public:
  /// \param plane_mm  sides of the plane that a window shows, > 0
  /// \throws as open_device, and DeviceError if the window that it needs cannot be had
  OpenedDevice(const std::string& driver, const device::DeviceSettings& settings, Vec2 plane_mm);
  ~OpenedDevice();
  OpenedDevice(const OpenedDevice&) = delete;
  OpenedDevice& operator=(const OpenedDevice&) = delete;

  [[nodiscard]] device::HapticDevice& device() noexcept { return *device_; }
  /// One picture of the window, about every 16 ms; without one, that long a pause.
  void attend();
  /// The person asks in the window to stop: the space bar, or closing it.
  [[nodiscard]] bool stop_asked() const;

 private:
  device::PointerExchange exchange_;
  device::PacedClock clock_{device::PacedClock::Time{}};
  std::unique_ptr<PointerWindow> window_;
  std::unique_ptr<device::HapticDevice> device_;
};

}  // namespace touchtrial::app

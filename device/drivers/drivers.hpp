/// \file Every driver of the registry. A new driver is declared and listed only here; its function
/// is defined in the driver's folder. Private to this folder.
#pragma once

#include "device/drivers/registry.hpp"

#include <vector>

namespace touchtrial::device {

/// `list` reports every Falcon on the USB and its problem, if any: permission, firmware, or use by
/// another program. `open` opens the one named in the settings.
[[nodiscard]] DeviceDriver falcon_driver();

/// `list` loads the library and briefly opens the device of the settings, without force: the
/// library has no other way to detect devices.
[[nodiscard]] DeviceDriver openhaptics_driver();

/// `list` loads the library and briefly opens each connected device, without force, to read its
/// name.
[[nodiscard]] DeviceDriver dhd_driver();

/// `list` queries the Inverse service for its devices, over HTTP with a short timeout.
[[nodiscard]] DeviceDriver inverse3_driver();

/// `list` loads the library of the settings and briefly opens its device, without force.
[[nodiscard]] DeviceDriver plugin_driver();

/// `list` finds a mouse if the environment names a display (DISPLAY, WAYLAND_DISPLAY). `open`
/// throws DeviceError, because the application owns the window and creates the MouseDevice.
[[nodiscard]] DeviceDriver mouse_driver();

/// `open` creates a hand that strokes a square plane of 100 mm for eight hours, always along the
/// same path. It moves once per tick, so in real time the servo's clock paces it.
[[nodiscard]] DeviceDriver simulated_driver();

/// Replays the file of DeviceSettings::replay. `list` reads it to check whether `open` will
/// succeed.
[[nodiscard]] DeviceDriver replay_driver();

/// \return all drivers, in the order in which the program lists them
[[nodiscard]] inline std::vector<DeviceDriver> all_drivers() {
  return {falcon_driver(), openhaptics_driver(), dhd_driver(),       inverse3_driver(),
          plugin_driver(), mouse_driver(),       simulated_driver(), replay_driver()};
}

}  // namespace touchtrial::device

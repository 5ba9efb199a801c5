/// \file The mouse in the registry.
#pragma once

#include "device/registry.hpp"

namespace touchtrial::device {

/// The name of the driver.
inline constexpr const char* kMouseDriver = "mouse";

/// Lists the mouse as present where a display is named (DISPLAY, WAYLAND_DISPLAY). `open` throws
/// DeviceError: a window is the app layer's, whose OpenedDevice (app/windows) makes one and the
/// MouseDevice beside it; whatever opens devices by name for a person goes through that.
[[nodiscard]] DeviceDriver mouse_driver();

}  // namespace touchtrial::device

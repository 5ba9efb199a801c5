/// \file OpenHaptics devices in the registry.
#pragma once

#include "device/registry.hpp"

namespace touchtrial::device {

/// `list` loads the library and asks it for the device of the settings, which it lets go of at
/// once; no force is switched on. The library has no other way to tell what is plugged in.
[[nodiscard]] DeviceDriver openhaptics_driver();

}  // namespace touchtrial::device

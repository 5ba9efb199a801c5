/// \file Force Dimension devices in the registry.
#pragma once

#include "device/registry.hpp"

namespace touchtrial::device {

/// `list` loads the library and opens each connected device for a moment, to read its name; no
/// force is switched on.
[[nodiscard]] DeviceDriver dhd_driver();

}  // namespace touchtrial::device

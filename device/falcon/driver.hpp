/// \file The Falcon in the registry.
#pragma once

#include "device/registry.hpp"

namespace touchtrial::device {

/// Lists every Falcon on the USB, with what is missing: permission, firmware, another program.
/// `open` takes the one that settings.falcon names.
[[nodiscard]] DeviceDriver falcon_driver();

}  // namespace touchtrial::device

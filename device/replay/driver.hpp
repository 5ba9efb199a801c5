/// \file Replay in the registry.
#pragma once

#include "device/registry.hpp"

namespace touchtrial::device {

/// Replays the file of DeviceSettings::replay. `list` reads it, to tell whether it can be replayed.
[[nodiscard]] DeviceDriver replay_driver();

}  // namespace touchtrial::device

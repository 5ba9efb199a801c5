/// \file The simulated hand in the registry.
#pragma once

#include "device/registry.hpp"

namespace touchtrial::device {

/// Side of the square plane that the hand strokes when it is opened by name.
constexpr double kSimulatedPlaneMm = 100.0;
/// How long it strokes, s: longer than anybody watches.
constexpr double kSimulatedExploreS = 8.0 * 3600.0;

/// A hand that strokes a square plane, always along the same path. In real time it lives by the
/// servo's ticks, so the servo's clock paces it.
[[nodiscard]] DeviceDriver simulated_driver();

}  // namespace touchtrial::device

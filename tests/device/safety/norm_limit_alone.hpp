/// \file Limits for tests of what is beside the chain: no link of it but the norm limit does
/// anything to a device that behaves.
#pragma once

#include "device/safety/safety_limits.hpp"

#include <limits>

namespace touchtrial {

[[nodiscard]] inline device::SafetyLimits norm_limit_alone(double max_force_n = 3.3) {
  device::SafetyLimits limits;
  limits.max_force_n = max_force_n;
  limits.max_slew_n_per_s = std::numeric_limits<double>::infinity();
  limits.max_speed_mm_s = std::numeric_limits<double>::infinity();
  limits.engage_force_n = std::numeric_limits<double>::infinity();
  limits.ramp_up_s = 0.0;
  return limits;
}

}  // namespace touchtrial

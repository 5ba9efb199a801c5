/// \file First link of the safety chain: numbers that are numbers.
#pragma once

#include "device/haptic_device.hpp"

#include <limits>

namespace touchtrial::device {

[[nodiscard]] inline double squared_norm(Vec3 a) noexcept {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}

/// Whether force, position and velocity are finite. Their squares are looked at, in one sum: that
/// also overflows for what is absurd without being infinite.
[[nodiscard]] inline bool is_finite_state(double force_squared_n2,
                                          const DeviceSample& sample) noexcept {
  const double all =
      force_squared_n2 + squared_norm(sample.position_mm) + squared_norm(sample.velocity_mm_s);
  return all <= std::numeric_limits<double>::max();
}

}  // namespace touchtrial::device

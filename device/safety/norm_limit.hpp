/// \file Link of the safety chain: the force's norm.
#pragma once

#include "device/safety/finite_check.hpp"

#include <cmath>

namespace touchtrial::device {

/// The force, shortened to the limit with its direction kept (to rounding).
/// \param force_n  whose square is finite
/// \param limit_n  > 0, finite
[[nodiscard]] inline Vec3 within_norm(Vec3 force_n, double limit_n) noexcept {
  const double squared_n2 = squared_norm(force_n);
  if (squared_n2 <= limit_n * limit_n) return force_n;
  return (limit_n / std::sqrt(squared_n2)) * force_n;
}

}  // namespace touchtrial::device

/// \file Checks that planes from callers have no NaN and no infinity.
#pragma once

#include "core/plane.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace touchtrial::engine {

/// Whether every sample is finite. Always reads all samples, so that the loop vectorises.
template <typename Real>
[[nodiscard]] bool all_finite(const Plane<Real>& plane) noexcept {
  unsigned outside = 0;
  for (const Real sample : plane.samples()) {
    outside |= static_cast<unsigned>(!(std::abs(sample) <= std::numeric_limits<Real>::max()));
  }
  return outside == 0;
}

/// \param caller,plane_name  for the message, for instance "tangential_force" and "surface"
/// \throws std::invalid_argument if a sample is NaN or infinite
template <typename Real>
void require_finite(const Plane<Real>& plane, const std::string& caller,
                    const std::string& plane_name) {
  if (all_finite(plane)) return;
  throw std::invalid_argument(caller + ": the " + plane_name + " has samples that are not finite");
}

}  // namespace touchtrial::engine

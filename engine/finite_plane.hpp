/// \file Checks planes for NaN and infinity.
#pragma once

#include "core/plane.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace touchtrial::engine {

/// Whether every sample is finite. Reads all samples without an early exit, so that the loop
/// vectorises.
template <typename Real>
[[nodiscard]] bool all_finite(const Plane<Real>& plane) noexcept {
  unsigned non_finite = 0;
  for (const Real sample : plane.samples()) {
    non_finite |= static_cast<unsigned>(!(std::abs(sample) <= std::numeric_limits<Real>::max()));
  }
  return non_finite == 0;
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

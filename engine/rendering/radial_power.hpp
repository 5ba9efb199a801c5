/// \file How much of a force field's power is finer than what can be rendered or felt.
/// Private to engine/rendering. Source: docs/method.md, "Rendering models".
#pragma once

#include "core/plane.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// For each limit, the share of the power of a vector field (both components, means removed) at
/// radial spatial frequencies above it; 0 for a constant field. The spectrum is that of the plane
/// repeated periodically.
/// \param x,y  the components, of one shape, at least 1 x 1
/// \param limits_cycles_per_px  a frequency that equals its limit but for rounding is not above it
/// Thread-safe. Cost: two real Fourier transforms.
[[nodiscard]] std::vector<double> power_shares_above(const Plane<double>& x, const Plane<double>& y,
                                                     std::span<const double> limits_cycles_per_px);

}  // namespace touchtrial::engine

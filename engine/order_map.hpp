/// \file From gradient to order of differentiation: the adaptive part of the method.
/// Source: docs/method.md, "CSGV and the order map" (paper Eq. 4).
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// Where the order's three branches meet; both values belong to the middle branch.
inline constexpr double kFlatBelowCsgv = 2.0;
inline constexpr double kSteepAboveCsgv = 128.0;

/// 0 below 2; CSGV / (3M) + 0.666 from 2 to 128; CSGV / (2M) + 0.499 above; M the plane's maximum.
/// \param csgv  >= 0 everywhere, not empty
/// \return dimensionless, in [0, 1), of the same shape
/// Thread-safe.
[[nodiscard]] Plane<double> order_map(const Plane<double>& csgv);

}  // namespace touchtrial::engine

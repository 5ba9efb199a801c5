/// \file The tangential texture force at pixel centres, before gains are applied.
/// Source: docs/method.md, "Force field" (paper Eqs. 9-12).
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// Force planes in grey levels per pixel, of the same shape as the surface.
template <typename Real>
struct ForceField {
  Plane<Real> x;  ///< along columns, positive to the right
  Plane<Real> y;  ///< along rows, positive downwards in the image
};

/// F(i) = sum over the neighbours j inside the image of (G_i - G_j)(p_j - p_i) / d^2. Points from
/// bright to dark. At the border only existing neighbours count. Real is float or double.
/// \param surface  G, grey levels, at least 1 x 1
/// \param neighbourhood  side n of the square neighbourhood, odd, >= 3; may exceed the image
/// \throws std::invalid_argument if the surface is empty or not finite, or n is even or < 3
template <typename Real>
[[nodiscard]] ForceField<Real> tangential_force(const Plane<Real>& surface, int neighbourhood);

}  // namespace touchtrial::engine

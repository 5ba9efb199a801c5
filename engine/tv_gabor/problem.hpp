/// \file What TV-Gabor minimises: J(u) + (lambda / 2) <f - u, K (f - u)> over u, on a torus.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"

namespace touchtrial {

template <typename Real>
struct TvGaborProblem {
  Plane<Real> image;     ///< f, grey levels
  Plane<Real> spectrum;  ///< of M = K^-1, in [0, 1], in the layout of RealFft's spectrum
  double lambda;         ///< weight of the texture norm
};

}  // namespace touchtrial

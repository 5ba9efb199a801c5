/// \file What TV-Gabor minimises: J(u) + (lambda / 2) <f - u, K (f - u)> over u, on a torus.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

namespace touchtrial::engine {

template <typename Real>
struct TvGaborProblem {
  Plane<Real> image;     ///< f, grey levels
  Plane<Real> spectrum;  ///< of M = K^-1, in [0, 1], in the layout of RealFft's spectrum
  double lambda;         ///< weight of the texture norm
};

/// \param image  at least 1 x 1
/// \param options  with explicit components
template <typename Real>
[[nodiscard]] TvGaborProblem<Real> tv_gabor_problem(const GreyImage& image,
                                                    const TvGaborOptions& options);

/// The mean of |grad f|, grey levels per pixel; more than 0 unless the image is flat.
template <typename Real>
[[nodiscard]] double mean_gradient(const Plane<Real>& torus);

}  // namespace touchtrial::engine

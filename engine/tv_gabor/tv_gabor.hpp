/// \file Cartoon and texture by TV-Gabor decomposition.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

#include <vector>

namespace touchtrial::engine {

template <typename Real>
struct TvGaborResult {
  Plane<Real> texture;  ///< v, grey levels, mean near zero; zero if the image is flat
  Plane<Real> cartoon;  ///< u = image - v
  std::vector<GaborComponent> components;  ///< those used; none if the image is flat
  double gap = 0.0;                        ///< relative primal-dual gap reached
  int steps = 0;                           ///< ADMM steps taken; 0 if the image is flat
  bool converged = true;
};

/// \param image  8-bit grey, at least 1 x 1
/// \param options  within the ranges that extraction.hpp states; not checked here
/// \throws std::invalid_argument if the image is empty, or too small to choose a component
/// Thread-safe. A step costs two Fourier transforms of the torus (540 x 540 for 500 x 500).
template <typename Real>
[[nodiscard]] TvGaborResult<Real> tv_gabor(const GreyImage& image, const TvGaborOptions& options);

}  // namespace touchtrial::engine

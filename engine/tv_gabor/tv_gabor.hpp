/// \file Cartoon and texture by TV-Gabor decomposition.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"

#include <vector>

namespace touchtrial::engine {

template <typename Real>
struct TvGaborResult {
  Plane<Real> texture;  ///< v, grey levels, mean near zero; zero if the image is flat
  Plane<Real> cartoon;  ///< u = image - v
  std::vector<GaborComponent> components;  ///< the components used; none if the image is flat
  double gap = 0.0;                        ///< relative primal-dual gap reached
  int steps = 0;                           ///< ADMM steps taken; 0 if the image is flat
  bool converged = true;
};

/// The strongest oscillation of an image: the component "auto". It is the largest sample of the
/// image's power spectrum (mean removed, Hann window) between 0.04 and 0.45 cycles per pixel; the
/// first in row order if several are equal. Thread-safe. Costs one Fourier transform in double.
/// \return direction in [0, 180) degrees
/// \throws std::invalid_argument if the image is empty, or both sides are below 3 pixels, so that
///   no frequency is in that range
[[nodiscard]] GaborComponent strongest_component(const GreyImage& image);

/// Decomposes an image. Thread-safe. From 2^20 pixels it uses all cores; results do not depend on
/// their number. A step costs two Fourier transforms of the torus (540 x 540 samples for 500 x 500
/// pixels).
/// \param image  8-bit grey, at least 1 x 1
/// \param options  in the ranges of TvGaborOptions; not checked
/// \throws std::invalid_argument if the image is empty, or too small to choose a component
template <typename Real>
[[nodiscard]] TvGaborResult<Real> tv_gabor(const GreyImage& image, const TvGaborOptions& options);

}  // namespace touchtrial::engine

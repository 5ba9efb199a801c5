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

/// The oscillation that makes up most of an image: the component "auto". It is the largest sample,
/// between 0.04 and 0.45 cycles per pixel, of the power spectrum of the image minus its mean under
/// a Hann window, on the image's own frequency grid; of equal samples, the first in row order.
/// Thread-safe. Costs one Fourier transform in double.
/// \return direction in [0, 180) degrees
/// \throws std::invalid_argument if the image is empty, or has both sides below 3 pixels: then its
///   grid has no frequency in that range
[[nodiscard]] GaborComponent strongest_component(const GreyImage& image);

/// Decomposes an image. Thread-safe; from 2^20 pixels on, it uses all cores, and digits do not
/// depend on their number. A step costs two Fourier transforms of the torus (540 x 540 samples for
/// 500 x 500 pixels).
/// \param image  8-bit grey, at least 1 x 1
/// \param options  in the ranges that extraction.hpp states; not checked here
/// \throws std::invalid_argument if the image is empty, or too small to choose a component
template <typename Real>
[[nodiscard]] TvGaborResult<Real> tv_gabor(const GreyImage& image, const TvGaborOptions& options);

}  // namespace touchtrial::engine

/// \file The four-tap Daubechies wavelet transform, level by level.
/// Source: docs/method.md, "Sub-bands" (paper Eq. 1).
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The four sub-bands of an H x W image, each ceil(H/2) x ceil(W/2). A constant c gives ll = 2c and
/// no details. The first letter is the filter along x, the second along y.
struct SubBands {
  Plane<double> ll;
  Plane<double> lh;  ///< low in x, high in y: horizontal edges
  Plane<double> hl;  ///< high in x, low in y: vertical edges
  Plane<double> hh;
};

/// Computes the first level from an image. It is the reference for the single-precision kernels.
/// \throws std::invalid_argument if the image is empty
/// Thread-safe.
[[nodiscard]] SubBands daub4_sub_bands(const GreyImage& image);
/// Computes the next level from the ll of the previous level.
[[nodiscard]] SubBands daub4_sub_bands(const Plane<double>& ll);

}  // namespace touchtrial::engine

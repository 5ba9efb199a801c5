/// \file One level of the Daubechies wavelet transform with four taps.
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

/// The first level, of an image. The kernels in single precision are tested against this.
/// \throws std::invalid_argument if the image is empty
/// Thread-safe.
[[nodiscard]] SubBands daub4_sub_bands(const GreyImage& image);
/// The next level, of the ll of the level before.
[[nodiscard]] SubBands daub4_sub_bands(const Plane<double>& ll);

}  // namespace touchtrial::engine

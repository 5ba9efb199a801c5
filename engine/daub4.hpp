/// \file One level of the Daubechies wavelet transform with four taps.
/// Source: docs/method.md, "DAUB4 sub-bands" (paper Eq. 1).
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The four sub-bands of an H x W image, each ceil(H/2) x ceil(W/2), in grey levels times 2 at
/// most: a constant c gives ll = 2c. The first letter is the filter along x, the second along y.
struct SubBands {
  Plane<double> ll;
  Plane<double> lh;  ///< low in x, high in y: horizontal edges
  Plane<double> hl;  ///< high in x, low in y: vertical edges
  Plane<double> hh;
};

/// In double: what the kernels in single precision are held against.
/// \throws std::invalid_argument if the image is empty
/// Thread-safe.
[[nodiscard]] SubBands daub4_sub_bands(const GreyImage& image);
/// The next level, of the ll of the one before.
[[nodiscard]] SubBands daub4_sub_bands(const Plane<double>& ll);

}  // namespace touchtrial::engine

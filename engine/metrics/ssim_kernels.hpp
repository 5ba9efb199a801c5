/// \file The loops of SSIM over pixels, vectorised for every target.
///
/// With the sum u = x + y and the difference v = x - y of the two images, and with variances and
/// means over a window,
///   1 - c s = 2 var v / (var u + var v + 2 C2),
///   1 - l   = 2 (mean v)^2 / ((mean u)^2 + (mean v)^2 + 2 C1).
/// So four moments do (u, v, u^2, v^2), no square root is taken, identical images give exactly 0,
/// and swapping the images changes only the sign of v. A constant is taken off u and v first: the
/// variances do not notice, and floats lose less.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// What was taken off u and v, in grey levels.
struct PairOffsets {
  int sum = 0;
  int difference = 0;
};

/// The first scale: u and v are formed from the images on the fly. Both have the same shape.
struct GreyPair {
  const GreyImage& x;
  const GreyImage& y;
  PairOffsets offsets;
};

/// A further scale: u and v less their offsets.
template <typename Real>
struct SumDifference {
  Plane<Real> sum;
  Plane<Real> difference;
  PairOffsets offsets;
};

/// Means over all windows; each is 0 for identical images.
struct MeanDeficits {
  double structure = 0.0;   ///< of 1 - c s
  double luminance = 0.0;   ///< of 1 - l
  double similarity = 0.0;  ///< of 1 - l c s
};

enum class Luminance { skip, include };

/// \param luminance  skip: only `structure` is computed
/// Every side must be at least 11.
template <typename Real>
[[nodiscard]] MeanDeficits mean_deficits(const GreyPair& pair, Luminance luminance);
template <typename Real>
[[nodiscard]] MeanDeficits mean_deficits(const SumDifference<Real>& pair, Luminance luminance);

/// Means of 2 x 2 blocks; an odd last row or column is repeated.
template <typename Real>
[[nodiscard]] SumDifference<Real> halved(const GreyPair& pair);
template <typename Real>
[[nodiscard]] SumDifference<Real> halved(const SumDifference<Real>& pair);

}  // namespace touchtrial::engine

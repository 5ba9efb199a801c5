/// \file The pixel loops of MS-SSIM, vectorised for every target.
///
/// With the sum u = x + y and the difference v = x - y of the two images, and with variances and
/// means over a window,
///   1 - c s = 2 var v / (var u + var v + 2 C2),
///   1 - l   = 2 (mean v)^2 / ((mean u)^2 + (mean v)^2 + 2 C1).
/// So four moments suffice (u, v, u^2, v^2), no square root is needed, identical images give
/// exactly 0, and swapping the images only changes the sign of v. A constant is subtracted from u
/// and v first: it does not change the variances, and it saves precision in float.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The constants subtracted from u and v, in grey levels.
struct PairOffsets {
  int sum = 0;
  int difference = 0;
};

/// The first scale; u and v are computed from the images on the fly. Both have the same shape.
struct GreyPair {
  const GreyImage& x;
  const GreyImage& y;
  PairOffsets offsets;
};

/// A pair whose offsets are the rounded means of u and v.
[[nodiscard]] GreyPair centred_pair(const GreyImage& x, const GreyImage& y);

/// A further scale: u and v minus their offsets.
template <typename Real>
struct SumDifference {
  Plane<Real> sum;
  Plane<Real> difference;
  PairOffsets offsets;
};

/// Means over all windows. Each is 0 for identical images.
struct MeanDeficits {
  double structure = 0.0;  ///< of 1 - c s
  double luminance = 0.0;  ///< of 1 - l
};

enum class Luminance { skip, include };

/// \param pair  every side is at least 11
/// \param luminance  skip: only `structure` is computed
template <typename Real>
[[nodiscard]] MeanDeficits mean_deficits(const GreyPair& pair, Luminance luminance);
template <typename Real>
[[nodiscard]] MeanDeficits mean_deficits(const SumDifference<Real>& pair, Luminance luminance);

}  // namespace touchtrial::engine

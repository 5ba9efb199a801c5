/// \file Structural similarity of two pictures, at one scale and at five.
/// Source: docs/method.md, "Metrics" (paper Eqs. 6-8). The window is an 11 x 11 Gaussian of
/// standard deviation 1.5 that lies inside the image; moments are population moments; K1 = 0.01, K2
/// = 0.03, L = 255, C3 = C2 / 2.
///
/// Real is the precision of the sums, float or double. Float stays within 2e-7 of double on
/// textures and within 2e-5 on any pair of images, and takes half the time.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The least side of an image for ssim() and ms_ssim(), in pixels.
inline constexpr int kSsimSmallestSide = 11;
inline constexpr int kMsSsimSmallestSide = 161;

/// The mean of l c s over all windows: in [-1, 1], and exactly 1 for an image and itself.
/// Exactly symmetric in its arguments.
/// \throws std::invalid_argument if the sizes differ or a side is below kSsimSmallestSide
/// Thread-safe. Works in constant memory.
template <typename Real>
[[nodiscard]] double ssim(const GreyImage& a, const GreyImage& b);

/// The product over five scales of the mean of c s, and of the mean of l at the fifth.
struct MsSsim {
  double unit;  ///< every exponent 1, as in the paper
  double wang;  ///< exponents 0.0448, 0.2856, 0.3001, 0.2363, 0.1333; negative means count as 0
};

/// From scale to scale the images are halved by the means of 2 x 2 blocks; an odd last row or
/// column is repeated. Both figures are exactly 1 for an image and itself, and symmetric. \throws
/// std::invalid_argument if the sizes differ or a side is below kMsSsimSmallestSide Thread-safe.
/// Needs 5/8 of a Real per pixel while it runs.
template <typename Real>
[[nodiscard]] MsSsim ms_ssim(const GreyImage& a, const GreyImage& b);

}  // namespace touchtrial::engine

/// \file Multi-scale structural similarity (MS-SSIM) of two pictures. Source: docs/method.md,
/// "Metrics" (paper Eqs. 6-8). The window is an 11 x 11 Gaussian of standard deviation 1.5 inside
/// the image; moments are population moments; K1 = 0.01, K2 = 0.03, L = 255, C3 = C2 / 2.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The least side of an image for ms_ssim(), in pixels.
inline constexpr int kMsSsimSmallestSide = 161;

/// The product over five scales of the mean of c s, and of the mean of l at the fifth scale.
struct MsSsim {
  double unit;  ///< with every exponent 1, as in the paper
  double wang;  ///< exponents 0.0448, 0.2856, 0.3001, 0.2363, 0.1333; a negative mean counts as 0
};

/// Each scale halves the images by means of 2 x 2 blocks; an odd last row or column is repeated.
/// Both numbers are exactly 1 for an image and itself, and symmetric in the arguments. Real is the
/// precision of the sums, float or double. Float stays within 2e-7 of double on textures and within
/// 2e-5 on any pair of images, and takes half the time.
/// \throws std::invalid_argument if the sizes differ or a side is below kMsSsimSmallestSide
/// Thread-safe. Needs memory for 5/8 of a Real per pixel.
template <typename Real>
[[nodiscard]] MsSsim ms_ssim(const GreyImage& a, const GreyImage& b);

}  // namespace touchtrial::engine

/// \file Reference extractors cited by the paper, for comparison.
/// Source: docs/method.md, "Other extractors".
///
/// All functions use symmetric extension and return grey levels, exactly 0 on flat areas except for
/// luminance_texture(). They compute in double and round to Real, which is float or double. Besides
/// image and texture they need memory for a few rows; median_texture() needs a strip of rows. All
/// are thread-safe.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// T = I - Gaussian(I).
/// \param image  not empty
/// \param sigma_px  > 0
template <typename Real>
[[nodiscard]] Plane<Real> gaussian_texture(const GreyImage& image, double sigma_px);

/// T = I - median of the surrounding (2 * radius + 1)^2 samples where that exceeds the threshold in
/// magnitude, else 0. Exact. For large radii the cost per pixel does not depend on the radius.
/// \param image  not empty
/// \param radius  pixels, 1 .. 63
/// \param threshold_grey  >= 0
template <typename Real>
[[nodiscard]] Plane<Real> median_texture(const GreyImage& image, int radius, double threshold_grey);

/// T = min(127, norm of the Sobel gradient / divisor).
/// \param image  not empty
/// \param divisor  > 0
template <typename Real>
[[nodiscard]] Plane<Real> edge_texture(const GreyImage& image, double divisor);

/// T = I - 128: the picture itself as texture.
/// \param image  not empty
template <typename Real>
[[nodiscard]] Plane<Real> luminance_texture(const GreyImage& image);

}  // namespace touchtrial::engine

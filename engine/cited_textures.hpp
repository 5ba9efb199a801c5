/// \file The extractors that the paper cites, for comparison.
/// Source: docs/method.md, "Other extractors". All use symmetric extension; textures are in grey
/// levels, and exactly 0 on flat areas but for luminance_texture's. Computed in double, row by row,
/// and rounded to Real, which is float or double: beside image and texture they hold a few rows,
/// and median_texture a strip of the image. Thread-safe.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// T = I - Gaussian(I). \param image  not empty  \param sigma_px  > 0
template <typename Real>
[[nodiscard]] Plane<Real> gaussian_texture(const GreyImage& image, double sigma_px);

/// T = I - median of the (2 * radius + 1)^2 samples round it where that exceeds the threshold in
/// magnitude, else 0. Exact; the cost of a pixel does not depend on a large radius.
/// \param image  not empty  \param radius  pixels, 1 .. 63  \param threshold_grey  >= 0
template <typename Real>
[[nodiscard]] Plane<Real> median_texture(const GreyImage& image, int radius, double threshold_grey);

/// T = min(127, norm of the Sobel gradient / divisor). \param image  not empty  \param divisor  > 0
template <typename Real>
[[nodiscard]] Plane<Real> edge_texture(const GreyImage& image, double divisor);

/// T = I - 128: the picture itself is felt. \param image  not empty
template <typename Real>
[[nodiscard]] Plane<Real> luminance_texture(const GreyImage& image);

}  // namespace touchtrial::engine

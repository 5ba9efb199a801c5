/// \file Texture by the Gruenwald-Letnikov fractional difference in eight directions.
/// Source: docs/method.md, "Extraction".
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// T = sum over k = 1 .. radius of |c_k(v)| (I - R_k), in grey levels, where R_k is the mean of the
/// eight samples at distance k. Exactly 0 where the neighbourhood is flat; |T| <= 255 (1 - S_K).
/// \param image  not empty  \param radius  K, 1 .. ExtractionOptions::kMaxRadius
/// \param order  v in [0, 1), one for all pixels
/// Float stays within 4e-5 grey levels of double. Thread-safe.
template <typename Real>
[[nodiscard]] Plane<Real> gl_texture(const GreyImage& image, int radius, double order);

/// The same with an order for each pixel.
/// \param orders  v in [0, 1) at half resolution, ceil(H/2) x ceil(W/2): pixel (y, x) takes
///   orders(y / 2, x / 2), rounded down
template <typename Real>
[[nodiscard]] Plane<Real> gl_texture(const GreyImage& image, int radius,
                                     const Plane<double>& orders);

}  // namespace touchtrial::engine

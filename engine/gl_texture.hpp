/// \file Texture by the Gruenwald-Letnikov fractional difference in eight directions, and its
/// normalisations. Source: docs/method.md, "Extraction" and "Options".
///
/// The weights are c_0 = 1, c_k = c_{k-1} (k - 1 - v) / k. Their sum S_K = c_0 + .. + c_K = (1 - v)
/// (1 - v/2) .. (1 - v/K) is the response of the mask to a constant.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"

namespace touchtrial::engine {

/// T = sum over k = 1 .. K of |c_k(v)| (I - R_k), where R_k is the mean of the eight samples at
/// distance k. T is exactly 0 where the neighbourhood is flat, and |T| <= 255 (1 - S_K). Real is
/// double; in float the fixed method has extract_fixed().
/// \param image  not empty
/// \param radius  K, 1 .. ExtractionOptions::kMaxRadius
/// \param order  v in [0, 1), the same for all pixels
/// \return T in grey levels
/// Thread-safe.
template <typename Real>
[[nodiscard]] Plane<Real> gl_texture(const GreyImage& image, int radius, double order);

/// The same with an order for each pixel. Real is float, which stays within 4e-5 grey levels of
/// double, or double.
/// \param orders  v in [0, 1) at half resolution, ceil(H/2) x ceil(W/2): pixel (y, x) takes
///   orders(y / 2, x / 2), rounded down
template <typename Real>
[[nodiscard]] Plane<Real> gl_texture(const GreyImage& image, int radius,
                                     const Plane<double>& orders);

/// \param order  v, dimensionless, in [0, 1)
/// \param radius  K, >= 1
/// \return S_K, in (0, 1]
/// \throws std::invalid_argument if the order is NaN or outside [0, 1), or the radius is below 1
[[nodiscard]] double gl_weight_sum(double order, int radius);

/// Turns the additive texture T into T / S_K (sum) or T + S_K (I - mean of I) (none); additive
/// changes nothing. In double precision only: near v = 1 the sum S_K is small, and rounding 1 - v
/// to float would cause errors of whole grey levels.
/// \param texture  gl_texture<double>(image, radius, order)
/// Thread-safe.
void apply_norm(Norm norm, const GreyImage& image, int radius, double order,
                Plane<double>& texture);

/// The same with an order for each pixel.
/// \param orders  at half resolution, as for gl_texture()
void apply_norm(Norm norm, const GreyImage& image, int radius, const Plane<double>& orders,
                Plane<double>& texture);

}  // namespace touchtrial::engine

/// \file Fractional textures under another normalisation of the mask.
/// Source: docs/method.md, "Options".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_choices.hpp"

namespace touchtrial::engine {

/// What the weights c_0 = 1, c_k = c_{k-1} (k - 1 - v) / k leave of a constant:
/// S_K = c_0 + .. + c_K = (1 - v) (1 - v/2) .. (1 - v/K), in (0, 1]. A texture lies within
/// 255 (1 - S_K) of zero.
/// \param order  v, dimensionless, in [0, 1)
/// \param radius  K, >= 1
/// \throws std::invalid_argument if the order is NaN or outside [0, 1), or the radius is below 1
[[nodiscard]] double gl_weight_sum(double order, int radius);

/// Turns the additive texture T into T / S_K (sum) or T + S_K (I - mean) (none), with
/// S_K = gl_weight_sum(v, radius); additive leaves it as it is. In double alone: near v = 1 the sum
/// S_K is small, and a float's 1 - v would cost whole grey levels.
/// \param texture  gl_texture<double>(image, radius, orders)
/// \param order  v in [0, 1), one for all pixels
/// Thread-safe.
void apply_norm(Norm norm, const GreyImage& image, int radius, double order,
                Plane<double>& texture);

/// The same with an order for each pixel.
/// \param orders  at half resolution, as gl_texture takes them
void apply_norm(Norm norm, const GreyImage& image, int radius, const Plane<double>& orders,
                Plane<double>& texture);

}  // namespace touchtrial::engine

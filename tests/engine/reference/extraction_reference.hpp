/// \file The extraction methods, slow and literal: every formula of docs/method.md as it stands, a
/// direct sum for each sample, and nothing shared with the code of the product.
#pragma once

#include "core/plane.hpp"

#include <cmath>
#include <string>

namespace touchtrial::reference {

enum class Tap { low, high };

/// One sub-band of an image, or of a sub-band of doubles. `along_x` and `along_y` are the filters
/// of the two directions.
template <typename Sample>
[[nodiscard]] Plane<double> sub_band(const Plane<Sample>& plane, Tap along_x, Tap along_y);

/// CSGV by Eqs. 2-3, at the image's resolution.
[[nodiscard]] Plane<double> csgv(const GreyImage& image);

/// CSGV with the method's options.
/// \param gradient  "sobel", "prewitt", "central"
/// \param combine  "sum", "l2", "max"
[[nodiscard]] Plane<double> csgv(const GreyImage& image, int levels, const std::string& gradient,
                                 const std::string& combine);

/// Eq. 4, from CSGV at the image's resolution.
[[nodiscard]] Plane<double> order_map(const Plane<double>& csgv);

/// Whether a CSGV is so close to 2 or 128 that rounding may lead to another branch of the order
/// map.
[[nodiscard]] inline bool is_at_branch_point(double csgv) {
  return std::abs(csgv - 2.0) < 1e-3 || std::abs(csgv - 128.0) < 1e-3;
}

/// The fractional difference over the eight directions, with an order for each pixel.
[[nodiscard]] Plane<double> texture(const GreyImage& image, const Plane<double>& orders,
                                    int radius);

/// The texture of the mask I + sum c_k R_k with a norm: "additive" mask - S I, "sum" mask / S - I,
/// "none" mask - S mean.
[[nodiscard]] Plane<double> texture(const GreyImage& image, const Plane<double>& orders, int radius,
                                    const std::string& norm);

[[nodiscard]] Plane<double> gaussian_texture(const GreyImage& image, double sigma_px);
[[nodiscard]] Plane<double> median_texture(const GreyImage& image, int radius, double threshold);
[[nodiscard]] Plane<double> edge_texture(const GreyImage& image, double divisor);

}  // namespace touchtrial::reference

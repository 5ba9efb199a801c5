/// \file The adaptive method's options and the other extractors, slow and literal: the formulas of
/// docs/method.md as they stand, nothing shared with the product's code.
#pragma once

#include "core/plane.hpp"

#include <string>

namespace touchtrial::reference {

/// CSGV at the image's resolution. \param gradient  "sobel", "prewitt", "central"
/// \param combine  "sum", "l2", "max"
[[nodiscard]] Plane<double> csgv(const GreyImage& image, int levels, const std::string& gradient,
                                 const std::string& combine);

/// The texture of the mask I + sum c_k R_k under a norm: "additive" mask - S I, "sum" mask / S - I,
/// "none" mask - S mean.
[[nodiscard]] Plane<double> texture(const GreyImage& image, const Plane<double>& orders, int radius,
                                    const std::string& norm);

[[nodiscard]] Plane<double> gaussian_texture(const GreyImage& image, double sigma_px);
[[nodiscard]] Plane<double> median_texture(const GreyImage& image, int radius, double threshold);
[[nodiscard]] Plane<double> edge_texture(const GreyImage& image, double divisor);

}  // namespace touchtrial::reference

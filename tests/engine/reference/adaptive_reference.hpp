/// \file The adaptive method, slow and literal: every formula of docs/method.md as it stands, a
/// direct sum for each sample, nothing shared with the product's code.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::reference {

enum class Tap { low, high };

/// One sub-band of an image, or of a sub-band of doubles: `along_x` and `along_y` say which filter
/// runs in which direction.
template <typename Sample>
[[nodiscard]] Plane<double> sub_band(const Plane<Sample>& plane, Tap along_x, Tap along_y);

/// Eqs. 2-3, at the image's resolution.
[[nodiscard]] Plane<double> csgv(const GreyImage& image);

/// Eq. 4, of a CSGV at the image's resolution.
[[nodiscard]] Plane<double> order_map(const Plane<double>& csgv);

/// The fractional difference over the eight directions, an order for each pixel.
[[nodiscard]] Plane<double> texture(const GreyImage& image, const Plane<double>& orders,
                                    int radius);

}  // namespace touchtrial::reference

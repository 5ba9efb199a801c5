/// \file The adaptive method's filter alone, on the engine's kernels, so that it can be timed.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::bench {

/// Additive, with an order for each pixel.
/// \param orders  v in [0, 1), the image's shape
/// \param texture  receives the texture; used again if it has the right shape
void filter_adaptive(const GreyImage& image, int radius, const Plane<float>& orders,
                     Plane<float>& texture);

}  // namespace touchtrial::bench

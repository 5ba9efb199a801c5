/// \file The composite sub-band gradient (CSGV): how much an image changes at a place, in all
/// sub-bands together. Source: docs/method.md, "CSGV and the order map" (paper Eqs. 2-3).
#pragma once

#include "core/plane.hpp"
#include "engine/daub4.hpp"

namespace touchtrial {

/// Sum over the sub-bands of the norm of the un-normalised Sobel gradient, at the sub-bands'
/// resolution: sample (y, x) stands for the image's samples (2y, 2x) to (2y+1, 2x+1).
/// \param bands  four planes of one shape, not empty
/// \return >= 0, exactly 0 everywhere for a flat image
/// Thread-safe.
[[nodiscard]] Plane<double> composite_gradient(const SubBands& bands);

/// A half-resolution plane at the image's resolution: sample (y, x) is half(y / 2, x / 2), rounded
/// down. \param height,width  of the image; half has ceil(height/2) x ceil(width/2) samples
template <typename Real>
[[nodiscard]] Plane<Real> doubled(const Plane<double>& half, int height, int width);

}  // namespace touchtrial

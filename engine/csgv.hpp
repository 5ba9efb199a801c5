/// \file The composite sub-band gradient (CSGV): how much an image changes at a place, in all
/// sub-bands together. Source: docs/method.md, "Gradient and order map" and "Options" (paper Eqs.
/// 2-3).
#pragma once

#include "core/plane.hpp"
#include "engine/daub4.hpp"
#include "engine/extraction_choices.hpp"

#include <span>

namespace touchtrial::engine {

/// The norms of the gradients of the last level's ll and of the details of every level, combined,
/// at the first level's resolution: sample (y, x) stands for the image's samples (2y, 2x) to
/// (2y+1, 2x+1), and deeper levels are brought to it by doubling, level by level.
/// \param levels  at least one, each made from the ll of the one before it; planes not empty
/// \return >= 0, exactly 0 everywhere for a flat image
/// Thread-safe.
[[nodiscard]] Plane<double> composite_gradient(std::span<const SubBands> levels, Gradient gradient,
                                               Combine combine);

/// The method's default: one level, Sobel, the sum.
[[nodiscard]] Plane<double> composite_gradient(const SubBands& bands);

/// A half-resolution plane at the image's resolution: sample (y, x) is half(y / 2, x / 2), rounded
/// down. \param height,width  of the image; half has ceil(height/2) x ceil(width/2) samples
template <typename Real>
[[nodiscard]] Plane<Real> doubled(const Plane<double>& half, int height, int width);

}  // namespace touchtrial::engine

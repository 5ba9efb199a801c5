/// \file The torus on which TV-Gabor is stated: the image with mirrored margins.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// Samples that the torus holds before the image on each axis; after it there are as many or more.
inline constexpr int kTorusMargin = 16;

/// The smallest even length >= n + 2 * kTorusMargin with no prime factor above 7, quick for any FFT
/// (500 -> 540). \param n  length of an image axis, >= 1
[[nodiscard]] int torus_length(int n);

/// The image extended symmetrically to torus_length on each axis, kTorusMargin before it.
template <typename Real>
[[nodiscard]] Plane<Real> extended_to_torus(const GreyImage& image);

/// The part of a torus plane that lies over an image of the given shape.
template <typename Real>
[[nodiscard]] Plane<Real> cropped_from_torus(const Plane<Real>& torus, int height, int width);

}  // namespace touchtrial::engine

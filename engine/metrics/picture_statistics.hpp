/// \file Statistics of one picture: the entropy of its grey levels and the slope of its spectrum.
/// Source: docs/method.md, "Metrics" (paper Eq. 5).
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The entropy of the 256-bin histogram, in nats: 0 for a constant image, at most ln 256.
/// \throws std::invalid_argument if the image is empty
/// Thread-safe.
[[nodiscard]] double entropy(const GreyImage& image);

/// The least side of an image for spectrum_slope(), in pixels.
inline constexpr int kSlopeSmallestSide = 32;

/// The slope of log power over log radial frequency: about -2 for photographs of scenes, 0 for
/// white noise. The image minus its mean is multiplied by a Hann window. Its power is averaged over
/// rings of a quarter of an octave, from 4 cycles per shorter side to 0.4 cycles per pixel, and a
/// line is fitted by least squares to the rings with coefficients and power.
/// \return 0 for a flat image
/// \throws std::invalid_argument if a side is below kSlopeSmallestSide
/// Thread-safe.
[[nodiscard]] double spectrum_slope(const GreyImage& image);

}  // namespace touchtrial::engine

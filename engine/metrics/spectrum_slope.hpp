/// \file How fast the power of a picture falls with spatial frequency.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// The least side of an image for spectrum_slope(), in pixels.
inline constexpr int kSlopeSmallestSide = 32;

/// Slope of log power over log radial frequency: about -2 for photographs of scenes, 0 for white
/// noise. The image less its mean is Hann-windowed, its power averaged over rings a quarter of an
/// octave wide from 4 cycles in the shorter side to 0.4 cycles a pixel, and a line fitted by least
/// squares through the rings that hold a coefficient and power.
/// \return 0 for a flat image
/// \throws std::invalid_argument if a side is below kSlopeSmallestSide
/// Thread-safe.
[[nodiscard]] double spectrum_slope(const GreyImage& image);

}  // namespace touchtrial::engine

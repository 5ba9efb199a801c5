/// \file The oscillation that an image consists of most: the component "auto" of TV-Gabor.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

namespace touchtrial::engine {

/// The frequencies among which the strongest is looked for, cycles per pixel: below them lies
/// shading, above them hardly more than the pixel grid.
inline constexpr double kLowestPeakFrequency = 0.04;
inline constexpr double kHighestPeakFrequency = 0.45;

/// The largest sample of the power spectrum of the image less its mean under a Hann window, on the
/// image's own grid of frequencies; the first of several, by rows.
/// \return direction in [0, 180) degrees
/// \throws std::invalid_argument if the image is empty or no frequency of its grid is in the range:
///   both sides below 3 pixels
/// Thread-safe. Costs one Fourier transform in double.
[[nodiscard]] GaborComponent strongest_component(const GreyImage& image);

}  // namespace touchtrial::engine

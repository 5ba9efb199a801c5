/// \file What a picture promises to the hand: the kinds of intensities that a hand feels, read from
/// its grey levels. Source: docs/method.md, "Pictured features".
#pragma once

#include "core/plane.hpp"
#include "engine/perception/felt_features.hpp"

namespace touchtrial::engine {

/// Natural logarithms of root mean squares, in the order of FeltFeatures: of the grey levels'
/// gradient (grey levels per mm) in place of the lateral force, of the grey levels in place of the
/// normal force. Only wavelengths of the felt bands count. The picture's edges fade (Hann), so that
/// they are no texture. Absolute values mean nothing to a hand; differences between pictures do.
/// Cost: three Fourier transforms of the picture in double precision.
/// \param pitch_mm  millimetres per pixel, > 0
/// \throws std::invalid_argument if the picture is empty or the pitch out of range
[[nodiscard]] FeltFeatures features_of_picture(const GreyImage& picture, double pitch_mm);

}  // namespace touchtrial::engine

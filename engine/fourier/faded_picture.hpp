/// \file Prepares a picture for a Fourier transform. Private to engine.
#pragma once

#include "core/plane.hpp"
#include "engine/fourier/real_fft.hpp"

namespace touchtrial::engine {

/// Fills the transform's plane with a picture minus its mean, multiplied by a Hann window in both
/// directions, so that opposite edges match.
/// \param fft  of the picture's size
void load_windowed(const GreyImage& picture, RealFft<double>& fft);

}  // namespace touchtrial::engine

/// \file Pink noise that covers what a device sounds like.
#pragma once

#include <cstdint>
#include <vector>

namespace touchtrial::app {

/// Above this the noise's peaks and a tone together could leave the range of the sound card.
inline constexpr double kHighestMaskingDbfs = -18.0;

/// A loop of pink noise (equal power in every octave): as many sums of random steps as there are
/// octaves, each half as fast as the one before (Voss and McCartney; Gardner, Scientific American
/// 238(4), 1978). Its last sample is followed by its first without a seam.
/// \param level_dbfs  rms in decibels below full scale, exactly; the highest level if it is above
/// \param seed  decides every sample
/// \return 2^18 samples, 5.5 s at 48 kHz, without a constant part; |sample| < 0.8
[[nodiscard]] std::vector<float> masking_noise(double level_dbfs, std::uint64_t seed);

}  // namespace touchtrial::app

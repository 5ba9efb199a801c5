/// \file Weights that scale a spectrum of the tip's acceleration to thresholds. Source:
/// docs/perception.md, "What is felt".
#pragma once

#include "engine/perception/vibration_threshold.hpp"

#include <vector>

namespace touchtrial::engine {

/// Weights of the bins of Welch's method in Hann windows, so that the weighted powers of the
/// acceleration in any sine from 10 Hz to 0.4 of the rate sum to its power over that of a sine at
/// the threshold, within 0.5 dB. The acceleration is one of samples: the second difference of
/// places, which at 0.32 of the rate is 3 dB less than the true one. A sine's power spreads over
/// four bins, and thresholds differ between them by up to 16 dB: the thresholds of the bins' own
/// frequencies would be wrong by more. Below 10 Hz the acceleration counts as at 10 Hz. Computed
/// once for each curve, window and rate; thread-safe.
/// \param window  samples, even, 64 to 65536
/// \param rate_hz  of the samples, 100 or more
/// \return by bin 0 .. window / 2, s^4/m^2, of one-sided powers; the first is 0
/// \throws std::invalid_argument if window or rate is out of range
[[nodiscard]] const std::vector<double>& threshold_weights(ThresholdCurve curve, int window,
                                                           double rate_hz);

}  // namespace touchtrial::engine

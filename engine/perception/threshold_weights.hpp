/// \file Weights that scale spectra of the tip's acceleration by the detection threshold. Source:
/// docs/perception.md, "What is felt".
#pragma once

#include "engine/perception/vibration_threshold.hpp"

#include <vector>

namespace touchtrial::engine {

/// Weights of the bins of Welch's method with Hann windows. For any sine from 10 Hz to 0.4 of the
/// rate, the weighted powers of the acceleration sum to its power relative to a sine at threshold,
/// within 0.5 dB. Acceleration is the second difference of sampled positions; at 0.32 of the rate
/// it is 3 dB below the true acceleration. A sine's power spreads over four bins whose thresholds
/// differ by up to 16 dB, so thresholds at the bins' centre frequencies would be less accurate.
/// Frequencies below 10 Hz have the threshold of 10 Hz. Computed once per curve, window and rate;
/// thread-safe.
/// \param window  samples, even, 64 to 65536
/// \param rate_hz  of the samples, 100 or more
/// \return weights of the one-sided powers in bins 0 .. window / 2, s^4/m^2; the first is 0
/// \throws std::invalid_argument if window or rate is out of range
[[nodiscard]] const std::vector<double>& threshold_weights(ThresholdCurve curve, int window,
                                                           double rate_hz);

}  // namespace touchtrial::engine

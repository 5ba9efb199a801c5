/// \file Trials and traces with the features that a test chooses.
#pragma once

#include "protocols/identification/analysis/cues/ideal_observer.hpp"
#include "record/trace.hpp"

#include <vector>

namespace touchtrial {

/// The difference between classes in synthetic features.
enum class Difference { none, strength, shape, direction };

/// `repeats` trials of each class, one after another, with a little noise on every feature; `index`
/// chooses the noise. Classes do not differ, or differ in the strength of all features alike, in
/// the band in which lateral and normal force are strongest (at equal strength), or only in
/// directions.
[[nodiscard]] std::vector<analysis::identification::ObservedTrial> felt_trials(
    Difference difference, int classes, int repeats, double noise = 0.02, std::uint64_t index = 0);

/// 3 s of strokes at 100 mm/s along x over 40 mm, with contact, feeling a lateral wave.
[[nodiscard]] record::Trace stroking_over_wave(double wavelength_mm, double amplitude_n);

}  // namespace touchtrial

/// \file Trials and traces that feel as a test wants.
#pragma once

#include "protocols/identification/analysis/cues/ideal_observer.hpp"
#include "protocols/store/trace.hpp"

#include <vector>

namespace touchtrial {

/// What sets classes apart in synthetic features.
enum class Difference { none, strength, shape, direction };

/// `repeats` trials of each class, one after another, with a little noise on every feature that is
/// drawn from the index. Classes differ in nothing, in the strength of all features alike, in which
/// band of the lateral and normal force is strongest with the strength kept, or in directions
/// alone.
[[nodiscard]] std::vector<analysis::identification::ObservedTrial> felt_trials(
    Difference difference, int classes, int repeats, double noise = 0.02, std::uint64_t index = 0);

/// 3 s of strokes at 100 mm/s along x over 40 mm, with contact, feeling a lateral wave.
[[nodiscard]] store::Trace stroking_over_wave(double wavelength_mm, double amplitude_n);

}  // namespace touchtrial

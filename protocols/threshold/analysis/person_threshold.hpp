/// \file What a participant's tracks come to in a mean over participants. Source:
/// docs/thresholds.md, "Groups".
#pragma once

#include "analysis/statistics/censored_mean.hpp"
#include "protocols/procedures/estimates.hpp"

#include <span>
#include <vector>

namespace touchtrial::analysis::threshold {

/// As what a track counts: with its observer's threshold if that lies inside the levels, else as
/// beyond the level at that end. If it lies inside and the interval is open on both sides, nothing
/// is known. That the interval of a threshold leaves the levels does not make it censored: a mean
/// without the numbers of those who are near an end would lie too far from it.
[[nodiscard]] Bounds bounds_of(const procedures::ThresholdEstimate& track,
                               std::span<const double> levels);

/// What is known of one participant's threshold of a standard, in units of the level.
struct PersonThreshold {
  Bounds bounds{};
  /// no: it is known; undetermined: neither it nor a side.
  procedures::Censored censored = procedures::Censored::undetermined;

  friend bool operator==(const PersonThreshold&, const PersonThreshold&) = default;
};

/// The mean of the participant's own tracks, or of their bounds.
/// \param tracks  at least one
[[nodiscard]] PersonThreshold person_threshold(
    std::span<const procedures::ThresholdEstimate> tracks, std::span<const double> levels);

[[nodiscard]] std::vector<Bounds> bounds_of(std::span<const PersonThreshold> people);

}  // namespace touchtrial::analysis::threshold

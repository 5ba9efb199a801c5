/// \file One participant's threshold from the tracks, for means over participants. Source:
/// docs/thresholds.md, "Groups".
#pragma once

#include "analysis/statistics/censored_mean.hpp"
#include "protocols/procedures/estimates.hpp"

#include <span>
#include <vector>

namespace touchtrial::analysis::threshold {

/// The bounds with which a track enters the mean. They are the observer's threshold if that lies
/// inside the levels, and otherwise the range beyond the level at that end. If it lies inside but
/// its interval is open on both sides, the bounds are open. An interval that extends beyond the
/// levels does not make the threshold censored: dropping numbers near an end would bias the mean.
[[nodiscard]] Bounds bounds_of(const procedures::ThresholdEstimate& track,
                               std::span<const double> levels);

/// One participant's threshold at a standard, in units of the level.
struct PersonThreshold {
  Bounds bounds{};
  /// no: the threshold is known; undetermined: neither the threshold nor its side is known.
  procedures::Censored censored = procedures::Censored::undetermined;

  friend bool operator==(const PersonThreshold&, const PersonThreshold&) = default;
};

/// The mean of the participant's own tracks, or of their bounds.
/// \param tracks  at least one
[[nodiscard]] PersonThreshold person_threshold(
    std::span<const procedures::ThresholdEstimate> tracks, std::span<const double> levels);

[[nodiscard]] std::vector<Bounds> bounds_of(std::span<const PersonThreshold> people);

}  // namespace touchtrial::analysis::threshold

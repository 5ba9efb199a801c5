/// \file One participant's threshold from the tracks, for means over participants. Source:
/// docs/thresholds.md, "Groups".
#pragma once

#include "analysis/statistics/censored_mean.hpp"
#include "protocols/procedures/estimates.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis::threshold {

/// The bounds with which a track enters the mean. A number enters as it is. Any other track, also
/// an undetermined one, enters by its observer's threshold: with that if it lies inside the levels,
/// else with the range beyond the levels on its side. Both bounds are open, and the track has no
/// share in the mean, if the threshold lies inside and the interval of somebody with usual lapse
/// rates is open on both sides. To leave out tracks near an end would bias the mean.
[[nodiscard]] Bounds bounds_of(const procedures::ThresholdEstimate& track,
                               std::span<const double> levels);

/// One participant's threshold at a standard, in units of the level.
struct PersonThreshold {
  Bounds bounds{};
  /// Of the own tracks; undetermined where they differ. The bounds do not tell it: an undetermined
  /// track has some too.
  procedures::Censored censored = procedures::Censored::undetermined;

  friend bool operator==(const PersonThreshold&, const PersonThreshold&) = default;
};

/// The mean of the participant's own tracks, or of their bounds.
/// \param tracks  at least one
[[nodiscard]] PersonThreshold person_threshold(
    std::span<const procedures::ThresholdEstimate> tracks, std::span<const double> levels);

/// First minus second: known if both are; undetermined if one of them is, or if both bounds are
/// open.
[[nodiscard]] PersonThreshold difference_of(const PersonThreshold& first,
                                            const PersonThreshold& second) noexcept;

[[nodiscard]] std::vector<Bounds> bounds_of(std::span<const PersonThreshold> people);

/// The mean of everybody by their bounds. If more than half are undetermined, there is neither a
/// mean nor a median (Lack::most).
/// \param level  of the interval, in (0, 1)
[[nodiscard]] CensoredMean mean_of(std::span<const PersonThreshold> people,
                                   double level = kConfidenceLevel);

/// The test of that mean (censored_p); nothing without a mean.
[[nodiscard]] std::optional<double> p_of(std::span<const PersonThreshold> people, double null,
                                         Sides sides);

}  // namespace touchtrial::analysis::threshold

/// \file A participant's threshold from tracks, for means over participants. Source:
/// docs/thresholds.md, "Groups".
#pragma once

#include "analysis/statistics/censored_mean.hpp"
#include "protocols/procedures/estimates.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis::threshold {

/// The bounds with which a track enters the mean: its threshold, if known; otherwise the likeliest
/// threshold, if this is within the levels; otherwise the range beyond the levels on that side.
/// Both bounds are open, and the track does not enter the mean, if the likeliest threshold is
/// within the levels but the interval for usual lapse rates is open on both sides. Omitting tracks
/// near an end would bias the mean.
[[nodiscard]] Bounds bounds_of(const procedures::ThresholdEstimate& track,
                               std::span<const double> levels);

/// A participant's threshold at a standard, in units of the level.
struct PersonThreshold {
  Bounds bounds{};
  /// The state of the tracks; undetermined if they differ. It cannot be derived from the bounds,
  /// because undetermined tracks also have bounds.
  procedures::Censored censored = procedures::Censored::undetermined;

  friend bool operator==(const PersonThreshold&, const PersonThreshold&) = default;
};

/// The mean of the participant's tracks, or of their bounds.
/// \param tracks  at least one
[[nodiscard]] PersonThreshold person_threshold(
    std::span<const procedures::ThresholdEstimate> tracks, std::span<const double> levels);

/// First minus second: known if both are known; undetermined if either is, or if both bounds are
/// open.
[[nodiscard]] PersonThreshold difference_of(const PersonThreshold& first,
                                            const PersonThreshold& second) noexcept;

[[nodiscard]] std::vector<Bounds> bounds_of(std::span<const PersonThreshold> people);

/// The censored mean over participants. If more than half are undetermined, there is no mean and no
/// median (MissingReason::most).
/// \param level  of the interval, in (0, 1)
[[nodiscard]] CensoredMean mean_of(std::span<const PersonThreshold> people,
                                   double level = kConfidenceLevel);

/// The p of mean_of, by censored_p; nothing without a mean.
[[nodiscard]] std::optional<double> p_of(std::span<const PersonThreshold> people, double null,
                                         Sides sides);

}  // namespace touchtrial::analysis::threshold

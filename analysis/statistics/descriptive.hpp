/// \file Descriptive statistics of a sample: mean with Student's t interval, median and quartiles.
/// Sources: docs/statistics.md, "Participants as clusters" and "Reaction times"; Hyndman, Fan 1996.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// The arithmetic mean; NaN without values.
[[nodiscard]] double mean_of(std::span<const double> values);

/// The square root of the sum of squared deviations divided by `divisor`.
/// \param divisor  n for the values themselves, n - 1 to estimate the population's
[[nodiscard]] double standard_deviation(std::span<const double> values, double mean,
                                        double divisor);

/// Whether there are two or more values that are equal except for rounding. Then Student's t and
/// its interval do not exist, because the spread between people is unknown.
[[nodiscard]] bool all_alike(std::span<const double> values);

/// A mean over participants and its Student's t interval. A study samples participants; pooling
/// trials as if they were independent would make intervals too narrow.
struct MeanEstimate {
  int participants = 0;
  std::optional<double> mean;  ///< nothing without participants
  /// The full range with fewer than two participants; a point if all values are equal.
  Interval interval;
  std::optional<double> sd{};  ///< between participants, n - 1; nothing with fewer than two

  /// The interval to show: `interval`, or nothing if there are fewer than two participants or all
  /// values are equal. An interval of zero width would look like certainty.
  [[nodiscard]] std::optional<Interval> known_interval() const noexcept {
    return participants > 1 && interval.low < interval.high ? std::optional(interval)
                                                            : std::nullopt;
  }
};

/// \param values  one number per participant
/// \param range  of all possible values; the interval is clipped to it
/// \param level  in (0, 1)
/// \throws std::invalid_argument if the level is not in (0, 1), or a value is not finite
[[nodiscard]] MeanEstimate participant_mean(std::span<const double> values,
                                            Interval range = {0.0, 1.0},
                                            double level = kConfidenceLevel);

/// The quantile by definition 7 of Hyndman and Fan.
/// \param sorted  in ascending order
/// \param share  0 .. 1
/// \return nothing without values
/// \throws std::invalid_argument if the share is out of range
[[nodiscard]] std::optional<double> quantile(std::span<const double> sorted, double share);

struct Quartiles {
  int n = 0;
  std::optional<double> lower;
  std::optional<double> median;
  std::optional<double> upper;
};

/// \param values  in any order
/// \throws std::invalid_argument if a value is not finite
[[nodiscard]] Quartiles quartiles(std::vector<double> values);

}  // namespace touchtrial::analysis

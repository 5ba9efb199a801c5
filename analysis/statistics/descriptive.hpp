/// \file What describes a sample: its mean with Student's t interval, its median and quartiles.
/// Sources: docs/statistics.md, "Participants as clusters" and "Reaction times"; Hyndman, Fan 1996.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis {

/// The sum over the number of values; NaN without values.
[[nodiscard]] double mean_of(std::span<const double> values);

/// The root of the sum of squared distances from the mean over a divisor.
/// \param divisor  the number of values for these alone, one less for what they are a sample of
[[nodiscard]] double standard_deviation(std::span<const double> values, double mean,
                                        double divisor);

/// Whether two values or more do not differ, but for rounding. Student's t, and with it his
/// interval, then does not exist: nothing is known of how people differ.
[[nodiscard]] bool all_alike(std::span<const double> values);

/// A mean over participants and Student's t interval around it. Participants are the unit of which
/// a study has a sample; pooling all trials as if they were independent makes intervals too narrow.
struct MeanEstimate {
  int participants = 0;
  std::optional<double> mean;  ///< nothing without participants
  Interval
      interval;  ///< the whole range with fewer than two participants; a point if all are alike
  std::optional<double> sd{};  ///< between participants, n - 1; nothing with fewer than two

  /// The interval to show: `interval`, or nothing with fewer than two participants, and if all are
  /// alike: an interval without width would look like certainty.
  [[nodiscard]] std::optional<Interval> known_interval() const noexcept {
    return participants > 1 && interval.low < interval.high ? std::optional(interval)
                                                            : std::nullopt;
  }
};

/// \param values  one number per participant
/// \param range  of all possible values; the interval is cut to it
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

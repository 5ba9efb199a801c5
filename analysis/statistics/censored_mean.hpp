/// \file The mean over participants when some values are censored, for example a threshold beyond
/// the levels that were tried. It fits a normal distribution to all participants by maximum
/// likelihood. Dropping censored participants would bias the mean. Sources: docs/thresholds.md,
/// "Groups"; Tobin 1958; Olsen 1978.
#pragma once

#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"

#include <limits>
#include <optional>
#include <span>

namespace touchtrial::analysis {

/// The interval that contains one participant's value. If the ends are equal, the value is known.
/// An infinite end is open.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool exact() const noexcept { return low == high; }
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// The bounds of first minus second.
[[nodiscard]] Bounds difference_of(const Bounds& first, const Bounds& second) noexcept;

/// Why an estimate or its interval is missing.
enum class MissingReason {
  nothing,
  values,  ///< fewer than two known values: no interval, and no mean unless there is one
           ///< participant
  most,    ///< more than half of the values are unknown or without any bound: no mean
  spread,  ///< all known values are equal: no interval, and a mean only within everybody's bounds
};

/// A mean over participants, in the unit of the values.
struct CensoredMean {
  int participants = 0;  ///< with a value or a bound
  int exact = 0;         ///< participants with a value
  int open = 0;          ///< excluded people without any bound; not counted in `participants`
  std::optional<double> mean{};
  std::optional<Interval> interval{};
  std::optional<double> sd{};      ///< between participants
  Bounds median_within{};          ///< bounds of the median of all; open without participants
  std::optional<double> median{};  ///< if the bounds determine it
  MissingReason lack = MissingReason::values;
};

/// The mean and its interval by profile likelihood. The interval contains all means whose log
/// likelihood ratio, doubled, is at most m log(1 + t^2 / (m - 1)), with m known values and
/// Student's quantile t of m - 1 degrees. If all values are known, it is Student's interval.
/// \param level  in (0, 1)
/// \throws std::invalid_argument if the level is not in (0, 1), or bounds are NaN, in the wrong
///   order or the same infinity
[[nodiscard]] CensoredMean censored_mean(std::span<const Bounds> people,
                                         double level = kConfidenceLevel);

/// Tests the mean of censored_mean by the same likelihood ratio. If all values are known, this is
/// Student's t test.
/// \param null  the mean under the null hypothesis
/// \return nothing where censored_mean has no interval
/// \throws std::invalid_argument as censored_mean does, or if `null` is not finite
[[nodiscard]] std::optional<double> censored_p(std::span<const Bounds> people, double null,
                                               Sides sides);

/// Student's t of the same mean; nothing unless all values are known.
[[nodiscard]] std::optional<TStatistic> known_t_statistic(std::span<const Bounds> people);

}  // namespace touchtrial::analysis

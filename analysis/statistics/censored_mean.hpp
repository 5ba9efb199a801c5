/// \file The mean over participants when some values are censored, for example a threshold beyond
/// the levels that were tried: the maximum-likelihood normal distribution of all participants.
/// Dropping censored participants would bias the mean. Sources: docs/thresholds.md, "Groups"; Tobin
/// 1958; Olsen 1978.
#pragma once

#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"

#include <limits>
#include <optional>
#include <span>

namespace touchtrial::analysis {

/// The interval that contains one participant's value. Equal ends: the value is known. An infinite
/// end is open.
struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool exact() const noexcept { return low == high; }
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

/// The bounds of first minus second.
[[nodiscard]] Bounds difference_of(const Bounds& first, const Bounds& second) noexcept;

/// What an estimate lacks.
enum class Lack {
  nothing,
  values,  ///< fewer than two are known: no interval, and no mean unless there is one participant
  most,    ///< more than half are not known, counting those without any bound: no mean
  spread,  ///< the known ones are all alike: no interval, and a mean only within everybody's bounds
};

/// In the unit of the values.
struct CensoredMean {
  int participants = 0;  ///< with a value or a bound
  int exact = 0;         ///< of them, those with a value
  int open = 0;          ///< beside them, those without any bound, who have no share in the mean
  std::optional<double> mean{};
  std::optional<Interval> interval{};
  std::optional<double> sd{};      ///< between participants
  Bounds median_within{};          ///< bounds of the median of all; open without participants
  std::optional<double> median{};  ///< if the bounds determine it
  Lack lack = Lack::values;
};

/// The mean and its interval by profile likelihood: all means whose likelihood ratio is at most
/// m log(1 + t^2 / (m - 1)), of m known values, t being Student's quantile of m - 1 degrees. If all
/// are known that is Student's interval.
/// \param level  in (0, 1)
/// \throws std::invalid_argument if the level is not in (0, 1), a bound is NaN, a low one lies above
///   its high one, or both are the same infinity
[[nodiscard]] CensoredMean censored_mean(std::span<const Bounds> people,
                                         double level = kConfidenceLevel);

/// The test of that mean by the same likelihood ratio. If all values are known, it is Student's t
/// test.
/// \param null  the mean under the null hypothesis
/// \return nothing where censored_mean has no interval
/// \throws std::invalid_argument as censored_mean does, or if `null` is not finite
[[nodiscard]] std::optional<double> censored_p(std::span<const Bounds> people, double null,
                                               Sides sides);

/// Student's t of that mean; nothing unless all values are known.
[[nodiscard]] std::optional<TStatistic> known_t_statistic(std::span<const Bounds> people);

}  // namespace touchtrial::analysis

/// \file Student's test of a mean over participants, and the size of the effect. Sources:
/// docs/statistics.md, "The registered question"; Student 1908; Cumming, Finch 2001.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// Which means count against the null hypothesis: only larger ones, or those on both sides.
enum class Sides { one, two };

/// The one-sample t test of a mean over participants. If `all_alike`, t does not exist, and p is
/// that of sign flips of the distances from `null`: 2^-n or 2 * 2^-n, or 1 if the values equal
/// `null` or, one-sided, lie below it. A report must not call that p a t test.
/// \param values  one number per participant
/// \param null  the mean under the null hypothesis
/// \return p in [0, 1]; nothing with fewer than two values
/// \throws std::invalid_argument if a value or `null` is not finite
[[nodiscard]] std::optional<double> t_test_p(std::span<const double> values, double null,
                                             Sides sides);

/// Student's t of a mean over participants, and how far it lies from the null hypothesis in units
/// of their standard deviation.
struct TStatistic {
  double t = 0.0;
  int degrees_of_freedom = 0;
  double d = 0.0;  ///< Cohen's d; of differences d_z. Too large on average with few participants
  std::optional<Interval> interval{};  ///< of d: effect_interval
};

/// \param values  one number per participant
/// \param null  the mean under the null hypothesis
/// \return nothing with fewer than two values, or if `all_alike`
/// \throws std::invalid_argument if a value or `null` is not finite, or the level is not in (0, 1)
[[nodiscard]] std::optional<TStatistic> t_statistic(std::span<const double> values,
                                                    double null = 0.0,
                                                    double level = kConfidenceLevel);
/// The same without the interval, which is the expensive part.
[[nodiscard]] std::optional<TStatistic> t_statistic_without_interval(std::span<const double> values,
                                                                     double null = 0.0);

/// The d whose noncentral t distributions have the observed t at either tail. Assumes normal
/// values: it is too narrow for people whose differences scatter by very different amounts.
/// \return nothing if t is beyond kMaxT
[[nodiscard]] std::optional<Interval> effect_interval(const TStatistic& statistic,
                                                      double level = kConfidenceLevel);

/// Noncentral t distributions beyond this t are not computed.
inline constexpr double kMaxT = 1e4;

}  // namespace touchtrial::analysis

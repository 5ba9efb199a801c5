/// \file Student's test of a mean over participants, and the size of the effect. Sources:
/// docs/statistics.md, "The registered question"; Student 1908; Cumming, Finch 2001.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// The alternative hypothesis: only larger means, or larger and smaller ones.
enum class Sides { one, two };

/// The one-sample t test of a mean over participants. If all values are equal, t does not exist; p
/// then comes from sign flips of the distances from `null`: 2^-n or 2 * 2^-n, or 1 if the values
/// equal `null` or, one-sided, lie below it. A report must not call that p a t test.
/// \param values  one number per participant
/// \param null  the mean under the null hypothesis
/// \return p in [0, 1]; nothing with fewer than two values
/// \throws std::invalid_argument if a value or `null` is not finite
[[nodiscard]] std::optional<double> t_test_p(std::span<const double> values, double null,
                                             Sides sides);

/// Student's t of a mean over participants, and the effect size in units of their standard
/// deviation.
struct TStatistic {
  double t = 0.0;
  int degrees_of_freedom = 0;
  double d = 0.0;  ///< Cohen's d, or d_z of differences; biased upward with few participants
  std::optional<Interval> interval{};  ///< of d: effect_interval
};

/// \param values  one number per participant
/// \param null  the mean under the null hypothesis
/// \return nothing with fewer than two values, or if all values are equal
/// \throws std::invalid_argument if a value or `null` is not finite, or the level is not in (0, 1)
[[nodiscard]] std::optional<TStatistic> t_statistic(std::span<const double> values,
                                                    double null = 0.0,
                                                    double level = kConfidenceLevel);
/// Like t_statistic, but without the interval, which is expensive.
[[nodiscard]] std::optional<TStatistic> t_statistic_without_interval(std::span<const double> values,
                                                                     double null = 0.0);

/// The interval of d: noncentral t distributions with these d have the observed t at either tail.
/// Assumes normal values; it is too narrow if people's differences vary by very different amounts.
/// \return nothing if t is beyond kMaxT
[[nodiscard]] std::optional<Interval> effect_interval(const TStatistic& statistic,
                                                      double level = kConfidenceLevel);

/// Noncentral t distributions are not computed beyond this t.
inline constexpr double kMaxT = 1e4;

}  // namespace touchtrial::analysis

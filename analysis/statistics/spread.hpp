/// \file The true spread between participants, without the binomial noise of a limited number of
/// trials. Sources: docs/statistics.md, "Spread between participants"; Paule, Mandel 1982;
/// Viechtbauer 2007.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// The standard deviation of participants' own probabilities of a right answer.
struct Spread {
  double estimate = 0.0;
  Interval interval;
};

/// A participant's share of n right answers has the variance m (1 - m) / n + s^2 (1 - 1 / n), with
/// m the mean over participants and s the spread. The estimate is the s at which the squared
/// distances from the weighted mean, each divided by its variance, add up to the number of
/// participants less one; the interval has every s at which they lie within chi-square's quantiles.
/// \param participants  each with n >= 1; those with one trial carry no information and are left
///   out
/// \param level  in (0, 1)
/// \return nothing with fewer than two participants, or if all answers are right or all wrong
/// \throws std::invalid_argument if a proportion is impossible or has n < 1, or the level is not in
///   (0, 1)
[[nodiscard]] std::optional<Spread> spread_of(std::span<const Proportion> participants,
                                              double level = kConfidenceLevel);

}  // namespace touchtrial::analysis

/// \file The true spread between participants, without binomial noise. Sources: docs/statistics.md,
/// "Spread between participants"; Paule, Mandel 1982; Viechtbauer 2007.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// The standard deviation of participants' probabilities of a right answer.
struct Spread {
  double estimate = 0.0;
  Interval interval;
};

/// A participant's share of right answers in n trials has the variance
/// m (1 - m) / n + s^2 (1 - 1 / n), with m the mean over participants and s the spread. The squared
/// distances from the weighted mean are each divided by their variance and summed. The estimate is
/// the s at which the sum equals the number of participants less one. The interval contains every s
/// at which the sum lies within chi-square's quantiles.
/// \param participants  each with n >= 1; those with one trial are ignored
/// \param level  in (0, 1)
/// \return nothing with fewer than two participants, or if all answers are right or all wrong
/// \throws std::invalid_argument if a proportion is impossible or has n < 1, or the level is not in
///   (0, 1)
[[nodiscard]] std::optional<Spread> spread_of(std::span<const Proportion> participants,
                                              double level = kConfidenceLevel);

}  // namespace touchtrial::analysis

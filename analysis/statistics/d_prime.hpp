/// \file Nominal sensitivity in an m-alternative choice: the d' at which an unbiased observer of m
/// equally distant alternatives reaches a proportion correct. Also metacognitive sensitivity from
/// confidence ratings. Sources: docs/statistics.md, "d'" and "Confidence"; Green, Swets 1966;
/// Hacker, Ratcliff 1979; Fleming, Lau 2014.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// One answer with its confidence rating.
struct RatedAnswer {
  int rating = 0;  ///< higher is more confident
  bool correct = false;
};

/// The area under one participant's type-2 ROC curve: the probability that a right answer was rated
/// higher than a wrong one, with ties counting half. At 0.5, ratings are uninformative.
/// \return nothing unless there are both right and wrong answers
[[nodiscard]] std::optional<double> type_2_area(std::span<const RatedAnswer> answers);

/// The proportion correct at a d': the integral over z of phi(z - d) Phi(z)^(m - 1).
/// \param alternatives  >= 2
/// \return 0 .. 1; error below 1e-10
/// \throws std::invalid_argument if d is not finite or alternatives < 2
[[nodiscard]] double proportion_correct_of(double d_prime, int alternatives);

/// A nominal d'. If no or all answers are correct, a bound replaces the infinite estimate.
struct DPrime {
  std::optional<double> estimate;  ///< nothing at 0 % and 100 %
  std::optional<double> low;       ///< at the share's lower limit; nothing if that is 0
  std::optional<double> high;      ///< at its upper limit; nothing if that is 1
};

/// \param limits  an interval of the proportion correct; the d' at its ends form an interval of d'
///   with the same coverage
/// \throws std::invalid_argument if alternatives < 2, or the proportion or a limit is impossible
[[nodiscard]] DPrime d_prime(Proportion proportion, int alternatives, const Interval& limits);

/// Uses the limits of Clopper and Pearson's interval, which assumes independent trials.
/// \throws std::invalid_argument if alternatives < 2 or the proportion is impossible
[[nodiscard]] DPrime d_prime(Proportion proportion, int alternatives,
                             double level = kConfidenceLevel);

}  // namespace touchtrial::analysis

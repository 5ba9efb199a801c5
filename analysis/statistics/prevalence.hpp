/// \file Prevalence: the share of the population that would pass each participant's test. Sources:
/// docs/statistics.md, "Prevalence"; Ince, Paton, Kay, Schyns 2021.
#pragma once

#include "analysis/statistics/proportion.hpp"

#include <optional>

namespace touchtrial::analysis {

/// The share of the population that passes the test for reasons other than chance. It is a lower
/// bound on the share of people who can do the task, because a test of few trials misses some of
/// them.
struct Prevalence {
  int participants = 0;
  int passed = 0;         ///< participants whose p is within the level
  double level = 0.0;     ///< the mean attained level of the participants' tests
  double estimate = 0.0;  ///< posterior mode under a uniform prior
  Interval interval;      ///< highest posterior density
};

/// Estimates the prevalence g if a participant passes with probability a + (1 - a) g. The posterior
/// of the probability of passing is then Beta(passed + 1, failed + 1), truncated to [a, 1].
/// \param tests  `correct` counts the passed tests
/// \param level  a: the mean probability of passing by chance, in [0, 1)
/// \param share  the posterior probability of the interval, in (0, 1)
/// \return nothing without participants
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] std::optional<Prevalence> prevalence_of(Proportion tests, double level,
                                                      double share = kConfidenceLevel);

}  // namespace touchtrial::analysis

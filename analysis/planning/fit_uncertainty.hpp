/// \file The uncertainty of a fit: covariance, profile intervals, parametric bootstrap, and the
/// Monte Carlo error from the bank's finite size. Private to analysis/planning. Source:
/// docs/planning.md, "Uncertainty".
#pragma once

#include "analysis/planning/fit_evidence.hpp"
#include "analysis/planning/fit_problem.hpp"
#include "analysis/planning/subject_fit.hpp"

#include <cstdint>
#include <vector>

namespace touchtrial::planning {

/// A fitted problem with the inputs for its uncertainty.
struct FittedProblem {
  const FitProblem& problem;
  const FitCounts& counts;
  Optimum best;
  FitProblem::Tangent tangent;
  bool identifiable = false;       ///< the answers determine every number
  std::vector<double> covariance;  ///< [number x numbers + number]; regularised unless identifiable
};

/// \param best  the optimum of the problem
[[nodiscard]] FittedProblem fitted_problem(const FitProblem& problem, const FitCounts& counts,
                                           Optimum best);

/// The 95 % profile interval of a number: the values at which twice the log likelihood, with all
/// other numbers refitted, falls by less than 3.84. An end is missing if the likelihood does not
/// fall that far before the bound of the search, or if no end was found. Cost: about 5 fits per
/// side, at most 24.
[[nodiscard]] OpenInterval profile_interval(const FittedProblem& fitted, std::size_t number);

struct FitBootstrap {
  std::vector<std::vector<double>> numbers;  ///< [draw][number]: refitted
  std::vector<double> g_squared;             ///< [draw]: against the refitted confusions
};

/// Simulates studies from a fit and refits them. Each study has the same people, presentations and
/// layouts; each person's noise, lapses and biases are drawn from the fitted population (32 people
/// represent it). A log-linear model with the fit's probabilities and slopes is refitted to the
/// drawn answers. Cost: about 1 ms per draw.
/// \param jobs  threads; results do not depend on them
[[nodiscard]] FitBootstrap bootstrap_fit(const FittedProblem& fitted, int draws, std::uint64_t seed,
                                         int jobs);

/// The standard error of each fitted number due to the bank's finite size. It is estimated from the
/// variation of the score between eight parts of the bank.
/// \return one error for each number; zeros unless the numbers are identifiable
[[nodiscard]] std::vector<double> monte_carlo_errors(const FittedProblem& fitted);

}  // namespace touchtrial::planning

/// \file Profile-likelihood intervals.
#pragma once

#include "analysis/planning/fit_problem.hpp"

#include <optional>
#include <vector>

namespace touchtrial::planning {

/// Ends of an interval of one number of a problem.
struct NumberInterval {
  /// Nothing: the likelihood does not fall enough before the bound, or no end was found.
  std::optional<double> lower;
  std::optional<double> upper;  ///< likewise
};

/// Where twice the log likelihood, all other numbers fitted anew, has fallen by 3.84 (95 %). Cost:
/// some 5 fits a side, 24 at most. \param best  of the problem
/// \param covariance  of the numbers, row-major, to begin with
[[nodiscard]] NumberInterval profile_interval(const FitProblem& problem, const Optimum& best,
                                              std::size_t number,
                                              const std::vector<double>& covariance);

}  // namespace touchtrial::planning

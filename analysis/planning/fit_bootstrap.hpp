/// \file Studies simulated from a fit: how far its figures would vary, and how well it should fit.
#pragma once

#include "analysis/planning/fit_counts.hpp"
#include "analysis/planning/fit_problem.hpp"

#include <cstdint>
#include <vector>

namespace touchtrial::planning {

struct FitBootstrap {
  std::vector<std::vector<double>> numbers;  ///< [draw][number]: refitted
  std::vector<double> g_squared;             ///< [draw]: against the refitted confusions
};

/// Each draw has as many people as the study, with the presentations and layouts that they had, and
/// each person's noise, lapses and biases are drawn from the fitted population (of 32 people who
/// represent it). Answers are drawn, and LocalAnswers refitted to them. A function of its
/// arguments, for any number of jobs. Cost: some 1 ms a draw. \param at  the fitted numbers of
/// `problem`
[[nodiscard]] FitBootstrap bootstrap_fit(const FitProblem& problem, const FitCounts& counts,
                                         const std::vector<double>& at, int draws,
                                         std::uint64_t seed, int jobs);

}  // namespace touchtrial::planning

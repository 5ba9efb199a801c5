/// \file Nominal significance levels for several looks at the data that together keep the type I
/// error rate. Sources: docs/statistics.md, "Registered looks"; Lan, DeMets 1983; Armitage,
/// McPherson, Rowe 1969.
#pragma once

#include "analysis/statistics/mean_test.hpp"

#include <span>
#include <vector>

namespace touchtrial::analysis {

/// The alpha-spending function: how much of alpha may be spent at a share of the information.
enum class AlphaSpending {
  /// Little at first: 2 (1 - Phi(z / sqrt(share))), with z the quantile of 1 - alpha / 2.
  obrien_fleming,
  pocock,  ///< about equal at every look: alpha log(1 + (e - 1) share)
};

/// The nominal level at each look: the test rejects if the p of the data so far does not exceed it.
/// Assumes multivariate normal statistics with independent increments, which holds for tests of
/// means of many participants. Two-sided tests spend half of alpha on each side.
/// \param alpha  of all looks together, in (0, 0.5]
/// \param shares  of the information at the looks, ascending, in (0, 1]
/// \return one level per look, to compare with the test's p; the error is below 1e-9 if looks are
///   at least 1e-5 of the information apart
/// \throws std::invalid_argument if an argument is out of range
[[nodiscard]] std::vector<double> nominal_levels(double alpha, Sides sides, AlphaSpending spending,
                                                 std::span<const double> shares);

}  // namespace touchtrial::analysis

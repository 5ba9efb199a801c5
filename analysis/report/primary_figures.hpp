/// \file The figures that decide a study, without the rest of its report: what planning makes
/// thousands of. Source: docs/statistics.md, "Above chance" and "Two methods".
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/method_comparison.hpp"
#include "analysis/statistics/participant_mean.hpp"

#include <optional>

namespace touchtrial::analysis {

/// One method against chance.
struct ChanceFigures {
  MeanEstimate mean;  ///< MethodReport::mean of the same outcomes
  /// MethodReport::chance; where orders are drawn by the study's rule, by fewer drawings.
  std::optional<ChanceTest> chance;
};

/// \param method  index into the outcomes' methods
/// \param most_deals  of orders that are drawn by the study's rule, >= 1; a report makes 9,999
[[nodiscard]] ChanceFigures chance_figures(const Outcomes& outcomes, int method, int most_deals);

/// Two methods, first minus second.
struct PairFigures {
  MethodComparison overall;  ///< MethodPair::overall of the same outcomes, without a bootstrap
  double attainable = 0.0;   ///< sign_flip_attainable at kSignificanceLevel, if asked for
};

/// \param with_attainable  also what the test can reach, which takes longer than the test
[[nodiscard]] PairFigures pair_figures(const Outcomes& outcomes, int first, int second,
                                       bool with_attainable);

}  // namespace touchtrial::analysis

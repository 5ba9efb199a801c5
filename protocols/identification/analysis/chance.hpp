/// \file The chance test over the orders that a study could as well have had.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"

#include <optional>

namespace touchtrial::analysis::identification {

inline constexpr int kMostChanceDeals = 9999;

/// How the study's rule deals the classes of a block.
[[nodiscard]] DealtOrder dealt_order(const design::Study& study);

/// Of one method's counted trials. Orders with a rule of their own are drawn from the study's own
/// maker of schedules; of a block only the places whose trials count are compared.
/// \param most_deals  of such a drawing
[[nodiscard]] std::optional<ChanceTest> chance_of(const Outcomes& outcomes, int method,
                                                  int most_deals = kMostChanceDeals);

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

}  // namespace touchtrial::analysis::identification

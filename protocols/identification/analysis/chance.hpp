/// \file The permutation test against chance, over the trial orders that the design could have
/// produced.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"

#include <optional>

namespace touchtrial::analysis::identification {

inline constexpr int kMostChanceDeals = 9999;

/// How the study's rule draws the order of classes in a block.
[[nodiscard]] DealtOrder dealt_order(const design::Study& study);

/// The chance test of one method's counted trials. If the study's rule is neither a plain shuffle
/// nor independent draws, the orders are drawn from schedules that the rule makes. In each block,
/// only the places whose trials count are compared.
/// \param most_deals  the most orders that are drawn from schedules
[[nodiscard]] std::optional<ChanceTest> chance_of(const Outcomes& outcomes, int method,
                                                  int most_deals = kMostChanceDeals);

/// One method against chance.
struct ChanceFigures {
  MeanEstimate mean;  ///< MethodReport::mean of the same outcomes
  /// MethodReport::chance; if the orders are drawn from schedules, possibly with fewer draws.
  std::optional<ChanceTest> chance;
};

/// \param method  index into the outcomes' methods
/// \param most_deals  the most orders that are drawn from schedules, >= 1; a report uses 9,999
[[nodiscard]] ChanceFigures chance_figures(const Outcomes& outcomes, int method, int most_deals);

/// The difference between two methods, first minus second.
struct PairFigures {
  MethodComparison overall;  ///< MethodPair::overall of the same outcomes, without a bootstrap
  double attainable = 0.0;   ///< sign_flip_attainable at kSignificanceLevel, if requested
};

/// \param with_attainable  also computes the attainable p, which takes longer than the test
[[nodiscard]] PairFigures pair_figures(const Outcomes& outcomes, int first, int second,
                                       bool with_attainable);

}  // namespace touchtrial::analysis::identification

/// \file The chance test over the orders that a study could as well have had.
/// Private to analysis/report.
#pragma once

#include "analysis/outcomes.hpp"
#include "analysis/statistics/chance_test.hpp"

#include <optional>

namespace touchtrial::analysis {

inline constexpr int kMostChanceDeals = 9999;

/// How the study's rule deals the classes of a block.
[[nodiscard]] DealtOrder dealt_order(const design::Study& study);

/// Of one method's counted trials. Orders with a rule of their own are drawn from the study's own
/// maker of schedules; of a block only the places whose trials count are compared.
/// \param most_deals  of such a drawing
[[nodiscard]] std::optional<ChanceTest> chance_of(const Outcomes& outcomes, int method,
                                                  int most_deals = kMostChanceDeals);

}  // namespace touchtrial::analysis

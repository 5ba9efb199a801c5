/// \file The permutation test against chance, over the trial orders that the design could have
/// produced.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/prevalence.hpp"

#include <optional>

namespace touchtrial::analysis::identification {

inline constexpr int kMostChanceDeals = 9999;

/// The chance test of one method's counted trials. If the study's rule is neither a plain shuffle
/// nor independent draws, the orders are drawn from schedules that the rule makes. In each block,
/// only the places whose trials count are compared.
/// \param most_deals  the most orders that are drawn from schedules
/// \param known  is used and completed, if not null
[[nodiscard]] std::optional<ChanceTest> chance_of(const Outcomes& outcomes, int method,
                                                  int most_deals = kMostChanceDeals,
                                                  KnownMatches* known = nullptr);

/// The prevalence of people who would pass the chance test of their own trials. Every participant's
/// test has the orders of chance_of; with orders drawn from schedules, each has 99 to 999 of them,
/// fewer in large studies.
/// \param known  is used and completed, if not null
/// \return nothing if no trial counts
[[nodiscard]] std::optional<Prevalence> own_prevalence(const Outcomes& outcomes, int method,
                                                       KnownMatches* known = nullptr);

}  // namespace touchtrial::analysis::identification

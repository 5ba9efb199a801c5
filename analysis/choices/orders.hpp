/// \file Randomisation tests over the orders of presentations that a study's design could have
/// produced: of answers against chance, and of order effects.
#pragma once

#include "analysis/choices/people.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/order_effects.hpp"
#include "analysis/statistics/prevalence.hpp"
#include "core/random.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace touchtrial::choices {

inline constexpr int kMaxChanceDeals = 9999;

/// The chance test of one method's counted trials. If the study's rule is neither a plain shuffle
/// nor independent draws, the orders are drawn from schedules that the rule makes. In each block,
/// only the places whose trials count are compared.
/// \param most_deals  the maximum number of orders drawn from schedules
/// \param known  is used and completed, if not null
[[nodiscard]] std::optional<analysis::ChanceTest> chance_of(
    const Outcomes& outcomes, int method, int most_deals = kMaxChanceDeals,
    analysis::KnownMatches* known = nullptr);

/// The prevalence of people who would pass the chance test on their own trials. Each participant is
/// tested as in chance_of; if orders are drawn from schedules, with 99 to 999 of them, fewer in
/// large studies.
/// \param known  a cache that is used and extended, if not null \return nothing if no trial counts
[[nodiscard]] std::optional<analysis::Prevalence> own_prevalence(
    const Outcomes& outcomes, int method, analysis::KnownMatches* known = nullptr);

/// Order effects in one method's counted trials, each moved within its block. The presentation
/// before a trial may be a lead-in, of another method, or not counted; those keep their places.
/// Uses 1,999 draws, fewer (at least 99) in large studies.
///
/// \return nothing if no trial counts
[[nodiscard]] std::optional<analysis::OrderEffects> order_of(const Outcomes& outcomes, int method);

/// How the study's rule draws the order of classes in a block.
[[nodiscard]] analysis::OrderRule dealt_order(const study::Study& study);

/// Draws orders of a block by the study's rule: takes one of 300 orders from the study's schedules
/// and one of 120 renamings of the classes, because every rule treats all classes alike.
class OrderDraws {
 public:
  /// \param blocks  for which orders are drawn, each on its own
  /// \param deals  how often
  /// \param purpose  of the random numbers
  OrderDraws(const study::Study& study, int method, std::size_t blocks, int deals,
             std::string_view purpose);

  /// The number of a block's scored presentations of the method.
  [[nodiscard]] std::size_t length() const { return orders_.front().size(); }

  /// \param block  in [0, blocks)
  /// \param deal  in [0, deals)
  /// \param places  the places in the order whose classes are returned, ascending, below length()
  [[nodiscard]] std::vector<int> drawn(std::size_t block, int deal,
                                       const std::vector<int>& places) const;

 private:
  std::size_t blocks_;
  RandomStream random_;
  std::vector<std::vector<int>> orders_;
  std::vector<std::vector<int>> renamings_;
  std::vector<int> picks_;
};

}  // namespace touchtrial::choices

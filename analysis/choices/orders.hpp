/// \file Randomisation tests over the orders of presentations that a study's design could have
/// produced: accuracy against chance, and order effects.
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
/// nor independent draws, orders are drawn from the rule's schedules. In each block, only the
/// places of counted trials are compared.
/// \param max_deals  the maximum number of orders drawn from schedules
/// \param cache  a cache that is used and extended, if not null
[[nodiscard]] std::optional<analysis::ChanceTest> chance_test_of(
    const Outcomes& outcomes, int method, int max_deals = kMaxChanceDeals,
    analysis::MatchCache* cache = nullptr);

/// The prevalence of people whose trials pass the chance test. Each participant is tested as in
/// chance_test_of, with 99 to 999 orders if these are drawn from schedules (fewer in large
/// studies).
/// \param cache  as in chance_test_of
/// \return nothing if no trial counts
[[nodiscard]] std::optional<analysis::Prevalence> prevalence_above_chance(
    const Outcomes& outcomes, int method, analysis::MatchCache* cache = nullptr);

/// Tests order effects in one method's counted trials, which are reordered within their blocks.
/// Presentations that are lead-ins, of another method, or not counted keep their places. Uses 1,999
/// draws, fewer (at least 99) in large studies.
/// \return nothing if no trial counts
[[nodiscard]] std::optional<analysis::OrderEffects> order_effects_of(const Outcomes& outcomes,
                                                                     int method);

/// How the study draws the order of classes in a block.
[[nodiscard]] analysis::OrderRule order_rule_of(const study::Study& study);

/// Draws orders of a block by the study's rule: combines one of 300 orders from the study's
/// schedules with one of 120 permutations of the classes, because every rule treats all classes
/// alike.
class OrderDraws {
 public:
  /// \param blocks  the number of blocks, which get independent orders
  /// \param deals  the number of draws
  /// \param purpose  labels the random stream
  OrderDraws(const study::Study& study, int method, std::size_t blocks, int deals,
             std::string_view purpose);

  /// The number of scored presentations of the method in a block.
  [[nodiscard]] std::size_t length() const { return orders_.front().size(); }

  /// \param block  in [0, blocks)
  /// \param deal  in [0, deals)
  /// \param places  the places in the order whose classes are returned, ascending, below length()
  [[nodiscard]] std::vector<int> classes_at(std::size_t block, int deal,
                                            const std::vector<int>& places) const;

 private:
  std::size_t blocks_;
  RandomStream random_;
  std::vector<std::vector<int>> orders_;
  std::vector<std::vector<int>> permutations_;
  std::vector<int> picks_;
};

}  // namespace touchtrial::choices

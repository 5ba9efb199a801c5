/// \file A crossover of two methods in two periods: the effect of the method, separated from the
/// effect of the period. Sources: docs/statistics.md, "Two methods in blocks"; Hills, Armitage
/// 1979; Senn 2002.
#pragma once

#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// One participant who felt both methods, one after the other.
struct CrossoverPerson {
  double difference = 0.0;  ///< accuracy with the first method minus accuracy with the second
  bool first_method_first = false;  ///< the first method was felt in the first period
  /// Partners share a number and were randomly assigned one order each. A participant without a
  /// partner (negative) got either order with the same probability.
  int block = -1;
};

/// Both effects are estimated from two groups: participants who had the first method first, and
/// those who had it last.
struct CrossoverEstimate {
  int first_first = 0;             ///< participants who had the first method first
  int second_first = 0;            ///< participants who had the second method first
  std::optional<double> effect{};  ///< first method minus second; nothing without both groups
  std::optional<double> period{};  ///< second period minus first; nothing without both groups
  /// Student's, with a pooled variance and n - 2 degrees of freedom; within [-1, 1]. Nothing with
  /// fewer than three participants, without both groups, or if values do not vary within groups.
  std::optional<Interval> interval{};
  std::optional<Interval> period_interval{};
  std::optional<double> p{};  ///< of the effect, by the same t
};

/// The period-adjusted comparison: half the difference between the groups' mean period differences,
/// equal to the mean of the groups' mean method differences. If values do not vary within groups, t
/// does not exist; p then comes from crossover_permutation.
/// \param null  the effect under the null hypothesis
/// \param level  of the intervals, in (0, 1)
/// \throws std::invalid_argument if a difference or `null` is not finite, or the level is not in
///   (0, 1)
[[nodiscard]] CrossoverEstimate crossover_estimate(std::span<const CrossoverPerson> people,
                                                   double null, Sides sides,
                                                   double level = kConfidenceLevel);

/// A randomisation test over the orders that could have been assigned.
struct CrossoverPermutation {
  double p = 1.0;
  double least = 1.0;  ///< the smallest p possible with these period differences
};

/// If the effect is `null` for everybody, results in a period do not depend on the order. So orders
/// are reassigned block by block: partners may exchange theirs, and everybody else may get either.
/// The statistic is the groups' difference in period differences. With up to kExactSignFlips blocks
/// all assignments are counted; beyond that, 99,999 random ones are drawn (Phipson, Smyth 2010).
/// \return nothing without both groups
/// \throws std::invalid_argument if a difference or `null` is not finite
[[nodiscard]] std::optional<CrossoverPermutation> crossover_permutation(
    std::span<const CrossoverPerson> people, double null, Sides sides);

}  // namespace touchtrial::analysis

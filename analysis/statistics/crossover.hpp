/// \file A crossover of two methods in two periods: the difference of the methods apart from that
/// of the periods. Sources: docs/statistics.md, "Two methods in blocks"; Hills, Armitage
/// 1979; Senn 2002.
#pragma once

#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"

#include <optional>
#include <span>

namespace touchtrial::analysis {

/// One participant who had both methods, one after the other.
struct CrossoverPerson {
  double difference = 0.0;        ///< accuracy with the first method less that with the second
  bool first_came_first = false;  ///< whether the first method had the first period
  /// Two participants with the same number were dealt one order each, at random. Somebody without a
  /// partner got either order with the same probability. Negative: without a partner.
  int block = -1;
};

/// Both effects are estimated from two groups: who had the first method first, and who had it last.
struct CrossoverEstimate {
  int first_first = 0;             ///< participants who had the first method first
  int second_first = 0;            ///< the others
  std::optional<double> effect{};  ///< first method less second; nothing without both groups
  std::optional<double> period{};  ///< second period less first, likewise
  /// Student's, with a pooled variance and two degrees fewer than participants; within [-1, 1].
  /// Nothing with fewer than three participants, without both groups, or if nobody differs from the
  /// own group.
  std::optional<Interval> interval{};
  std::optional<Interval> period_interval{};
  std::optional<double> p{};  ///< of the effect, by the same t
};

/// The period-adjusted comparison: half the difference between the groups' means of period
/// differences, which is the mean of the groups' mean differences of methods. If nobody differs
/// from the own group, t does not exist; p is then that of crossover_permutation.
///
/// \param null  the effect under the null hypothesis
/// \param level  of the intervals, in (0, 1)
/// \throws std::invalid_argument if a difference or `null` is not finite, or the level is not in
///   (0, 1)
[[nodiscard]] CrossoverEstimate crossover_estimate(std::span<const CrossoverPerson> people,
                                                   double null, Sides sides,
                                                   double level = kConfidenceLevel);

/// The check of that test by the orders that could have been dealt.
struct CrossoverPermutation {
  double p = 1.0;
  double least = 1.0;  ///< least p that these period differences could have, whatever the orders
};

/// If the effect is `null` for everybody, what a participant does in a period does not depend on
/// the order. So the orders are dealt again, block by block: partners exchange theirs, and
/// everybody else gets either. The statistic is the groups' difference in period differences. All
/// deals are counted up to kExactSignFlips blocks; beyond, 99,999 random ones (Phipson, Smyth
/// 2010).
///
/// \return nothing without both groups
/// \throws std::invalid_argument if a difference or `null` is not finite
[[nodiscard]] std::optional<CrossoverPermutation> crossover_permutation(
    std::span<const CrossoverPerson> people, double null, Sides sides);

}  // namespace touchtrial::analysis

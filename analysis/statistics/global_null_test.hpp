/// \file A test of the global null hypothesis, that the effect each participant was tested for is
/// absent in all of them. A pooled number misses a large effect in a few people; the smallest of
/// many p values misses a small effect in many. This test combines both. Sources:
/// docs/statistics.md, "Any participant"; Holm 1979; Fisher 1932, Statistical Methods for Research
/// Workers; Phipson, Smyth 2010.
#pragma once

#include <span>
#include <vector>

namespace touchtrial::analysis {

/// The usual number of deals: draws under the null hypothesis.
inline constexpr int kGlobalNullDeals = 9999;

struct GlobalNullResult {
  double p = 1.0;              ///< of the global null hypothesis: (b + 1) / (deals + 1)
  int deals = 0;               ///< draws under the null hypothesis
  int people = 0;              ///< participants tested
  int alone = 0;               ///< of them, those with an own p <= kSignificanceLevel
  double alone_by_chance = 0;  ///< expected `alone` under the null hypothesis

  /// Whether the global null hypothesis is rejected at kSignificanceLevel. This is always so if any
  /// participant's p, adjusted by Holm over all people, is within that level.
  [[nodiscard]] bool found() const noexcept;

  friend bool operator==(const GlobalNullResult&, const GlobalNullResult&) = default;
};

/// The p of each statistic: the share of all of them that are as large or larger. Under the null
/// hypothesis the statistics are exchangeable. By convention the first is the observed one, and the
/// others are drawn.
/// \return in the order of the statistics; ties (to within 1e-9) have the same p
[[nodiscard]] std::vector<double> ranked_p(std::span<const double> statistics);

/// Each deal has two numbers. One is the smallest own p times the number of people (Holm). The
/// other is the smaller of two ranks: that of Fisher's product of all own p, and that of a
/// statistic of all people together. The second number is scaled so that both have the same level
/// at kSignificanceLevel. p is the share of deals in which the smaller number is at most the
/// observed one.
class GlobalNullTest {
 public:
  /// \param people  their number
  /// \param deals  >= 1
  GlobalNullTest(int people, int deals);

  /// Adds a participant.
  /// \param p  the observed own p, then that of each deal. A deal's p must be valid: P(p <= a) <= a
  /// \throws std::invalid_argument if there are not 1 + deals, or one is not in (0, 1]
  void add(std::span<const double> p);

  /// \param together  a statistic of all people together, large against the null hypothesis:
  ///   observed, then in each deal
  /// \throws std::invalid_argument if there are not 1 + deals, or not as many people were added
  [[nodiscard]] GlobalNullResult result(std::span<const double> together) const;

 private:
  int people_;
  int added_ = 0;
  int alone_ = 0;
  int alone_in_deals_ = 0;
  std::vector<double> smallest_;  ///< p, observed and by deal
  std::vector<double> product_;   ///< Fisher's: minus the sum of the logarithms of p
};

}  // namespace touchtrial::analysis

/// \file A test of the global null hypothesis that no participant shows the effect. A pooled
/// statistic misses a large effect in a few people; the smallest of many p values misses a small
/// effect in many. This test combines both. Sources: docs/statistics.md, "Any participant"; Holm
/// 1979; Fisher 1932, Statistical Methods for Research Workers; Phipson, Smyth 2010.
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
  int alone = 0;               ///< participants whose individual p is <= kSignificanceLevel
  double alone_by_chance = 0;  ///< expected `alone` under the null hypothesis

  /// Whether the global null hypothesis is rejected at kSignificanceLevel. It always is if any
  /// participant's p, adjusted by Holm over all people, is within that level.
  [[nodiscard]] bool found() const noexcept;

  friend bool operator==(const GlobalNullResult&, const GlobalNullResult&) = default;
};

/// The p of each statistic: the share of all statistics that are as large or larger. Under the null
/// hypothesis they are exchangeable. By convention the first is observed, the others are drawn.
/// \return in the order of the statistics; ties (to within 1e-9) have the same p
[[nodiscard]] std::vector<double> ranked_p(std::span<const double> statistics);

/// The test computes two numbers per deal. One is the smallest individual p times the number of
/// people (Holm). The other is the smaller of two ranks: the rank of Fisher's product of all
/// individual p, and the rank of a pooled statistic. The second is scaled so that both have the
/// same level at kSignificanceLevel. p is the share of deals whose smaller number is at most the
/// observed one.
class GlobalNullTest {
 public:
  /// \param people  number of participants to add
  /// \param deals  >= 1
  GlobalNullTest(int people, int deals);

  /// Adds a participant.
  /// \param p  the participant's observed p, then the p of each deal; each must be a valid p value
  /// \throws std::invalid_argument if there are not 1 + deals values, or one is not in (0, 1]
  void add(std::span<const double> p);

  /// \param pooled  a statistic of all people together, observed, then in each deal. Large values
  ///   speak against the null hypothesis
  /// \throws std::invalid_argument if there are not 1 + deals values, or too few people were added
  [[nodiscard]] GlobalNullResult result(std::span<const double> pooled) const;

 private:
  int people_;
  int added_ = 0;
  int significant_ = 0;
  int significant_in_deals_ = 0;
  std::vector<double> smallest_;  ///< smallest p, observed and by deal
  std::vector<double> product_;   ///< Fisher's: minus the sum of the logarithms of p
};

}  // namespace touchtrial::analysis

/// \file Whether anybody does what each participant was tested for. A number pooled over people
/// hides a few who do much among many who do nothing, the smallest of many p hides many who do a
/// little; this test looks at both. Sources: docs/statistics.md, "Any participant"; Holm 1979;
/// Fisher 1932, Statistical Methods for Research Workers; Phipson, Smyth 2010.
#pragma once

#include <span>
#include <vector>

namespace touchtrial::analysis {

/// The deals of an `AnybodyTest` that people's trials allow as a rule.
inline constexpr int kAnybodyDeals = 9999;

struct Anybody {
  double p = 1.0;              ///< that nobody does: (b + 1) / (deals + 1)
  int deals = 0;               ///< draws under the null hypothesis
  int people = 0;              ///< who were tested
  int alone = 0;               ///< of them, those whose own p is within kSignificanceLevel
  double alone_by_chance = 0;  ///< how many that would be on average if nobody did

  /// Whether somebody does, at kSignificanceLevel for all people together. It is true wherever a
  /// participant's p adjusted by Holm over all people is within that level.
  [[nodiscard]] bool found() const noexcept;

  friend bool operator==(const Anybody&, const Anybody&) = default;
};

/// The p of each of some statistics, which the null hypothesis makes exchangeable: the share of all
/// of them that are as large or larger. The first, as a rule, is the observed one, the others are
/// drawn.
/// \return in the order of the statistics; ties (to within 1e-9) have the same p
[[nodiscard]] std::vector<double> ranked_p(std::span<const double> statistics);

/// Two numbers of each deal are compared: the smallest own p times people (Holm), and the smaller
/// of two ranks, of Fisher's product of all own p and of a statistic of all people together. The
/// second is scaled so that at kSignificanceLevel one level holds for both; p is the share of deals
/// of which the smaller of the two is as small as the observed one.
class AnybodyTest {
 public:
  /// \param people  who will be added
  /// \param deals  >= 1
  AnybodyTest(int people, int deals);

  /// Adds a participant.
  /// \param p  the own p, then that in each deal; p of a deal is at most a with a probability of at
  ///   most a
  /// \throws std::invalid_argument if there are not 1 + deals, or one is not in (0, 1]
  void add(std::span<const double> p);

  /// \param together  a statistic of all people together, large against the null hypothesis:
  ///   observed, then in each deal
  /// \throws std::invalid_argument if there are not 1 + deals, or not as many people were added
  [[nodiscard]] Anybody result(std::span<const double> together) const;

 private:
  int people_;
  int added_ = 0;
  int alone_ = 0;
  int alone_in_deals_ = 0;
  std::vector<double> smallest_;  ///< p, observed and by deal
  std::vector<double> product_;   ///< Fisher's: minus the sum of the logarithms of p
};

}  // namespace touchtrial::analysis

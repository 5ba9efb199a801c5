/// \file Tests of methods that the same participants felt, and the size of their difference. Two
/// methods: sign flips, the common odds ratio, and McNemar's test of one pair of answers per
/// participant. Three methods or more: Cochran's Q. Several tests: the adjustments of Holm and of
/// Benjamini and Hochberg. Sources: docs/statistics.md, "Two methods", "Odds ratio", "Pairs",
/// "Three methods or more" and "Several tests".
#pragma once

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/proportion.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace touchtrial::analysis {

/// One participant's proportion correct with each method.
struct PairedAccuracy {
  double first = 0.0;
  double second = 0.0;
};

/// The advantage of the first method over the second.
struct MethodComparison {
  int participants = 0;
  std::optional<double> difference;       ///< mean over participants of first minus second
  Interval interval{-1.0, 1.0};           ///< MeanEstimate::interval, within [-1, 1]
  std::optional<double> p;                ///< sign_flip_p of the differences
  std::optional<double> db;               ///< decibels of the two means
  std::optional<Interval> bootstrap{};    ///< bootstrap_mean of the differences
  std::optional<TStatistic> statistic{};  ///< of the differences

  /// See MeanEstimate::known_interval.
  [[nodiscard]] std::optional<Interval> known_interval() const noexcept {
    return participants > 1 && interval.low < interval.high ? std::optional(interval)
                                                            : std::nullopt;
  }
};

/// \param index,draws  of the bootstrap
/// \throws std::invalid_argument if a proportion is not finite, or draws < 1
[[nodiscard]] MethodComparison compare_methods(std::span<const PairedAccuracy> participants,
                                               std::uint64_t index = 0,
                                               int draws = kBootstrapDraws);

/// \return 10 log10(a / b); nothing unless both are > 0
[[nodiscard]] std::optional<double> decibels(double a, double b);

/// Up to this many participants, sign_flip_p counts all sign patterns; beyond that, it draws 99,999
/// at random.
inline constexpr int kExactSignFlips = 32;

/// The exact sign-flip test of paired differences: if two methods do not differ, each difference is
/// as likely to have the opposite sign. p is the share of sign patterns whose mean is at least as
/// far from zero as the observed one, or at least as large if one-sided. Beyond kExactSignFlips
/// participants it is (b + 1) / (m + 1) over m random patterns from a fixed seed (Phipson, Smyth
/// 2010).
/// \param differences  one per participant, finite
/// \return at least 2 * 2^-n, or 2^-n if one-sided, at most 1; nothing without differences
/// \throws std::invalid_argument if a difference is not finite
[[nodiscard]] std::optional<double> sign_flip_p(std::span<const double> differences,
                                                Sides sides = Sides::two);

/// The smallest p that sign_flip_p can return for differences of these sizes.
/// \return 1 if all differences are 0
[[nodiscard]] double sign_flip_min_p(std::span<const double> differences, Sides sides = Sides::two);

/// The largest attainable p within the level, over all signs of these differences: the test's true
/// rejection rate if the methods do not differ; 0 if it cannot reject. Costs about thirty times as
/// much as sign_flip_p.
/// \throws std::invalid_argument if a difference is not finite
[[nodiscard]] double sign_flip_attainable(std::span<const double> differences, double level);

struct OddsRatio {
  double estimate = 1.0;
  Interval interval;  ///< by Robins, Breslow and Greenland 1986, as if trials were independent
  std::optional<Interval> bootstrap{};  ///< odds_ratio_bootstrap
};

/// The odds of a right answer with the first method, divided by the odds with the second: Mantel
/// and Haenszel's (1959) common odds ratio, with one stratum per participant.
/// \param participants  each participant's trials with the first and the second method
/// \return nothing if the ratio is 0 or infinite
/// \throws std::invalid_argument if a proportion is impossible, or the level is not in (0, 1)
[[nodiscard]] std::optional<OddsRatio> mantel_haenszel(
    std::span<const std::pair<Proportion, Proportion>> participants,
    double level = kConfidenceLevel);

/// The interval of the common odds ratio over participants drawn with replacement, by expanded
/// percentiles. It is valid even if the methods' difference varies between participants.
/// \param index,draws  of the bootstrap
/// \return nothing with fewer than two participants, or if an end would be 0 or infinite
/// \throws std::invalid_argument as mantel_haenszel does, or if draws < 1
[[nodiscard]] std::optional<Interval> odds_ratio_bootstrap(
    std::span<const std::pair<Proportion, Proportion>> participants, std::uint64_t index = 0,
    int draws = kBootstrapDraws, double level = kConfidenceLevel);

/// McNemar's two-sided mid-p test of one pair of right-or-wrong answers per participant: the
/// probability of more extreme outcomes plus half the probability of equally extreme outcomes.
/// Source: Fagerland, Lydersen, Laake 2013.
/// \param first_only  pairs in which only the first answer is right, >= 0
/// \param second_only  pairs in which only the second answer is right, >= 0
/// \return 1 if no pair disagrees
/// \throws std::invalid_argument if a count is negative
[[nodiscard]] double mcnemar_mid_p(int first_only, int second_only);

struct CochranQ {
  double q = 0.0;
  int degrees_of_freedom = 0;  ///< methods - 1
  double p = 1.0;              ///< of q under chi-square; valid only for independent occasions
};

/// Cochran's (1950) test of several methods that are right or wrong on the same occasions.
/// \param occasions  for each occasion and method, whether the answer was right; of equal lengths
/// \return nothing if there are fewer than two methods, or methods differ on no occasion
/// \throws std::invalid_argument if lengths differ
[[nodiscard]] std::optional<CochranQ> cochran_q(std::span<const std::vector<bool>> occasions);

/// The p of the same statistic by permuting the methods within participants, which remains valid if
/// a participant's occasions are dependent. Monte Carlo, (b + 1) / (deals + 1), fixed seed.
/// \param by_participant  each participant's occasions
/// \param deals  random permutations, >= 1
/// \param index  chooses the stream of random numbers
/// \return nothing where cochran_q of all occasions returns nothing
/// \throws std::invalid_argument if lengths differ or deals < 1
[[nodiscard]] std::optional<double> cochran_q_permuted_p(
    std::span<const std::vector<std::vector<bool>>> by_participant, int deals = 9999,
    std::uint64_t index = 0);

/// Holm's (1979) adjustment, which controls the family-wise error rate.
/// \param p_values  each in [0, 1]
/// \return the adjusted p values in the order given, each in [0, 1]
/// \throws std::invalid_argument if a p is outside [0, 1]
[[nodiscard]] std::vector<double> holm_adjusted(std::span<const double> p_values);

/// Benjamini and Hochberg's (1995) adjustment, which controls the false discovery rate, and so the
/// family-wise error rate if all null hypotheses are true. Arguments, result and errors: see
/// holm_adjusted.
[[nodiscard]] std::vector<double> benjamini_hochberg_adjusted(std::span<const double> p_values);

}  // namespace touchtrial::analysis

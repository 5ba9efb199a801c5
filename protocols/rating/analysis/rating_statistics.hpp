/// \file Statistics of ratings on one scale, as pure functions: means, inter-rater agreement,
/// test-retest reliability, use of the scale, differences between methods, catch trials. The unit
/// is the participant, so people may differ in their use of the scale, in variance and in the
/// effects of methods.
///
/// A participant's repeats of an item are averaged first, so that all items have equal weight.
/// Means, differences and tables include only participants with all of their items; otherwise
/// missing items would confound participants with textures.
///
/// Sources: Shrout, Fleiss 1979 and McGraw, Wong 1996 (intraclass correlations and their
/// intervals); Donner 1986 (uneven numbers of repeats); Fisher 1925 (means of correlations);
/// Cumming, Finch 2001 and Miller 1974 (intervals of the standardised difference); Holm 1979.
#pragma once

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/proportion.hpp"

#include <compare>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::analysis::rating {

/// A rated item: the texture of a picture, rendered by a method.
struct Item {
  int texture_class = 0;
  int method = 0;

  friend auto operator<=>(const Item&, const Item&) = default;
};

/// One answer, in units of the scale: 0 to 1 on a line, 1 to k on points.
struct ItemRating {
  Item item;
  double value = 0.0;
};

/// The answers of one participant on one scale, in any order. Unanswered items are absent.
struct RatedParticipant {
  std::vector<ItemRating> scored;
  std::vector<double> catches;  ///< of catch trials, which have no texture
};

/// \name Means
/// \{

struct ItemMean {
  Item item;
  MeanEstimate mean;  ///< over participants
};

/// The mean over all items of one method or one class.
struct GroupMean {
  int group = 0;      ///< the method, or the class
  int items = 0;      ///< number of items in the mean
  MeanEstimate mean;  ///< over the participants who rated all of them
};

/// Means in ascending order of items, methods or classes, with t intervals in units of the scale.
struct RatingMeans {
  std::vector<ItemMean> items;
  std::vector<GroupMean> methods;
  std::vector<GroupMean> classes;
};

/// \param items  the items of the means; other ratings and duplicate items are ignored
/// \param scale  its ends, to which intervals are truncated
/// \param level  in (0, 1)
/// \throws std::invalid_argument if the scale's ends are not finite and ascending, a rating is beyond
///   them, or the level is out of range
[[nodiscard]] RatingMeans rating_means(std::span<const RatedParticipant> participants,
                                       std::span<const Item> items, const Interval& scale,
                                       double level = kConfidenceLevel);

/// \}
/// \name Reliability
/// \{

/// The two-way analysis of variance of a table with one number per cell. Rows are items, columns
/// are judges.
struct TwoWayMeanSquares {
  int rows = 0;
  int columns = 0;
  double between_rows = 0.0;     ///< in squared units of the scale, like the others
  double between_columns = 0.0;  ///< differences between people in overall level
  double residual = 0.0;         ///< interaction of people and rows, and error
};

/// \param table  rows of equal length
/// \return nothing with fewer than two rows or two columns
/// \throws std::invalid_argument if lengths differ, or a number is not finite
[[nodiscard]] std::optional<TwoWayMeanSquares> two_way_mean_squares(
    std::span<const std::vector<double>> table);

/// The share of variance due to the judged items. The estimate may be below 0, unlike the true
/// value.
struct IntraclassCorrelation {
  double estimate = 0.0;
  /// The interval by F quantiles with Satterthwaite's degrees of freedom, not truncated to the
  /// possible range. Nothing if there is less than one degree of freedom (only for estimates below
  /// 0) or agreement is perfect. It assumes equal error variances of people; otherwise it is too
  /// narrow.
  std::optional<Interval> interval{};
};

/// ICC(2,1), also ICC(A,1): absolute agreement of single random judges.
/// \param level  in (0, 1)
/// \return nothing if the denominator is not positive, such as for equal numbers
/// \throws std::invalid_argument if the level is out of range
[[nodiscard]] std::optional<IntraclassCorrelation> single_agreement(
    const TwoWayMeanSquares& squares, double level = kConfidenceLevel);

/// ICC(2,k), also ICC(A,k): absolute agreement of the mean over the judges of all columns.
/// \param level  in (0, 1)
/// \return nothing if its denominator is not positive; no interval if the denominator is not
///   positive at its lower end
/// \throws std::invalid_argument if the level is out of range
[[nodiscard]] std::optional<IntraclassCorrelation> average_agreement(
    const TwoWayMeanSquares& squares, double level = kConfidenceLevel);

/// ICC(1,1), by a one-way analysis of variance; groups may differ in size.
/// \param groups  repeats by item; those with fewer than two are ignored
/// \return in [-1, 1]; nothing with fewer than two such groups, or if all numbers are equal
/// \throws std::invalid_argument if a number is not finite
[[nodiscard]] std::optional<double> one_way_correlation(
    std::span<const std::vector<double>> groups);

/// Inter-rater agreement about the items.
struct Agreement {
  int items = 0;
  int participants = 0;                             ///< who rated all items
  int left_out = 0;                                 ///< all other participants
  std::optional<TwoWayMeanSquares> mean_squares{};  ///< of items (rows) and participants (columns)
  std::optional<IntraclassCorrelation> single{};    ///< single_agreement
  std::optional<IntraclassCorrelation> average{};   ///< average_agreement
};

/// \param items  as in rating_means
/// \param level  in (0, 1)
/// \throws std::invalid_argument if a rating is not finite, or the level is out of range
[[nodiscard]] Agreement agreement(std::span<const RatedParticipant> participants,
                                  std::span<const Item> items, double level = kConfidenceLevel);

/// Correlations are clamped to this magnitude before Fisher's z, which would be infinite for
/// perfect repetition.
inline constexpr double kMaxCorrelation = 0.99;

/// Test-retest reliability: ICC(1,1) of each participant's repeats. The form is one-way because
/// repeats are exchangeable in a random order, and drift over time should reduce reliability. It
/// depends on how much the items differ for the participant.
struct RetestReliability {
  std::vector<std::optional<double>> correlations;  ///< one_way_correlation
  int participants = 0;                             ///< with a correlation
  int clamped = 0;                     ///< participants with a correlation beyond kMaxCorrelation
  Quartiles quartiles{};               ///< of participants' correlations, not clamped
  std::optional<double> mean{};        ///< by Fisher's z; nothing without participants
  std::optional<Interval> interval{};  ///< t over participants' z; nothing with fewer than two
};

/// \param items  as in rating_means
/// \param level  in (0, 1)
/// \throws std::invalid_argument if a rating is not finite, or the level is out of range
[[nodiscard]] RetestReliability retest_reliability(std::span<const RatedParticipant> participants,
                                                   std::span<const Item> items,
                                                   double level = kConfidenceLevel);

/// \}
/// \name Use of the scale
/// \{

/// A participant uses a narrow part of the scale if the SD of answers is a smaller share of its
/// length.
inline constexpr double kNarrowUse = 0.05;

/// All scored answers of one participant, over items and repeats.
struct ScaleUse {
  Proportion at_low{};   ///< answers at the lower end
  Proportion at_high{};  ///< at the upper end
  std::optional<double> mean{};
  std::optional<double> sd{};  ///< n - 1; nothing with fewer than two answers
  int distinct = 0;            ///< different values
  bool is_narrow = false;      ///< the SD is below kNarrowUse of the scale's length
};

struct ScaleUses {
  std::vector<ScaleUse> participants;
  Proportion at_low{};  ///< over all participants
  Proportion at_high{};
  int narrow_count = 0;  ///< participants with narrow use
};

/// \param scale  its ends
/// \throws std::invalid_argument if they are not finite and ascending, or a rating is beyond them
[[nodiscard]] ScaleUses scale_use(std::span<const RatedParticipant> participants,
                                  const Interval& scale);

/// \}
/// \name Methods compared
/// \{

/// The p of one test in a family.
struct FamilyP {
  double p = 1.0;
  double holm = 1.0;  ///< holm_adjusted over the pairs that have a p
};

/// A mean difference in units of participants' standard deviation of it.
struct StandardisedDifference {
  double d_z = 0.0;
  std::optional<Interval> interval{};  ///< analysis::effect_interval
  /// The jackknife over participants, which does not assume normality and removes most of the bias
  /// of d_z. Nothing with fewer than three participants, or if all differences but one are equal.
  std::optional<JackknifeEstimate> jackknife_estimate{};
};

/// \param differences  one per participant
/// \param level  in (0, 1)
/// \return nothing with fewer than two differences, or if all are equal
/// \throws std::invalid_argument if a difference is not finite, or the level is out of range
[[nodiscard]] std::optional<StandardisedDifference> standardised_difference(
    std::span<const double> differences, double level = kConfidenceLevel);

/// The difference between the ratings of two methods. A participant's difference is the mean over
/// the classes of both methods.
struct MethodDifference {
  int first = 0;                    ///< method
  int second = 0;                   ///< method
  int classes = 0;                  ///< of both methods
  MeanEstimate difference;          ///< first minus second, in units of the scale
  std::optional<double> t{};        ///< n - 1 degrees of freedom; nothing if differences are equal
  std::optional<FamilyP> t_test{};  ///< t_test_p, two-sided; nothing without t
  std::optional<FamilyP> sign_flip{};  ///< sign_flip_p; nothing without participants
  std::optional<StandardisedDifference> standardised{};
};

/// All pairs of methods, in ascending order, the lower number first. Arguments and errors are those
/// of rating_means.
[[nodiscard]] std::vector<MethodDifference> method_differences(
    std::span<const RatedParticipant> participants, std::span<const Item> items,
    const Interval& scale, double level = kConfidenceLevel);

/// \}
/// \name Catch trials
/// \{

/// A participant who rated both catch and scored trials.
struct CatchRating {
  int participant = 0;  ///< index
  double catches = 0.0;
  double scored = 0.0;  ///< mean over the rated items' means
};

/// Tests whether people rate the texture rather than the picture: catch trials have no texture.
struct CatchComparison {
  std::vector<CatchRating> participants;
  MeanEstimate catches;     ///< of these participants
  MeanEstimate difference;  ///< scored minus catches, in units of the scale
  int not_lower = 0;        ///< participants who rate catch trials at least as high
};

/// \param items  the items to compare catch trials with; other arguments and errors as in
///   rating_means
[[nodiscard]] CatchComparison catch_comparison(std::span<const RatedParticipant> participants,
                                               std::span<const Item> items, const Interval& scale,
                                               double level = kConfidenceLevel);

/// \}

}  // namespace touchtrial::analysis::rating

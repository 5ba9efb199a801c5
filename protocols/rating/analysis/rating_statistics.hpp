/// \file What ratings on one scale come to: means, agreement between people and with themselves,
/// how the scale was used, methods compared, catch trials. Pure functions on numbers; the unit is
/// the participant, so people may differ in how they use the scale, in their scatter and in what a
/// method does to them. A study with several scales calls them once for each.
///
/// A participant's repeats of an item are averaged first, so that every item weighs the same.
/// A participant counts in a mean, a difference or a table only with all items that it is over:
/// otherwise easy and difficult textures would be mixed in other shares for those who miss some.
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

/// What was rated: a texture under its picture, as a method renders it.
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

/// The answers of one participant on one scale, in any order. What was not answered is not there.
struct RatedParticipant {
  std::vector<ItemRating> scored;
  std::vector<double> catches;  ///< of catch trials: a plane without texture under a picture
};

/// \name Means
/// \{

struct ItemMean {
  Item item;
  MeanEstimate mean;  ///< over participants' means of their repeats
};

/// Over all items of a method, or of a class.
struct GroupMean {
  int group = 0;      ///< the method, or the class
  int items = 0;      ///< that the mean is over
  MeanEstimate mean;  ///< over the participants who rated all of them
};

/// Each in ascending order, with t intervals in units of the scale.
struct RatingMeans {
  std::vector<ItemMean> items;
  std::vector<GroupMean> methods;
  std::vector<GroupMean> classes;
};

/// \param items  that the means are over; ratings of others are left out, twins count once
/// \param scale  its ends; intervals are cut to them
/// \param level  in (0, 1)
/// \throws std::invalid_argument if the scale's ends are not finite and ascending, a rating lies
///   beyond them, or the level is out of range
[[nodiscard]] RatingMeans rating_means(std::span<const RatedParticipant> participants,
                                       std::span<const Item> items, const Interval& scale,
                                       double level = kConfidenceLevel);

/// \}
/// \name Reliability
/// \{

/// The two-way analysis of variance of a table with one number in each cell. Rows are what is
/// judged, columns those who judge.
struct TwoWayMeanSquares {
  int rows = 0;
  int columns = 0;
  double between_rows = 0.0;     ///< squared units of the scale, as are the others
  double between_columns = 0.0;  ///< people who rate everything higher than others
  double residual = 0.0;         ///< people who rank the rows differently, and scatter
};

/// \param table  its rows, equally long
/// \return nothing with fewer than two rows or two columns
/// \throws std::invalid_argument if lengths differ, or a number is not finite
[[nodiscard]] std::optional<TwoWayMeanSquares> two_way_mean_squares(
    std::span<const std::vector<double>> table);

/// The share of the variance that comes from what is judged. An estimate may lie below 0; the
/// correlation itself does not.
struct IntraclassCorrelation {
  double estimate = 0.0;
  /// By F quantiles with Satterthwaite's degrees of freedom, not cut to what is possible. Nothing
  /// if these are fewer than one, which only estimates below 0 cause, or if everybody agrees in
  /// all. Assumes that people scatter alike: if some scatter much more, it is too narrow.
  std::optional<Interval> interval{};
};

/// ICC(2,1), also ICC(A,1): of one judge drawn at random, by absolute agreement.
/// \param level  in (0, 1)
/// \return nothing if its denominator is not positive, as when all numbers are the same
/// \throws std::invalid_argument if the level is out of range
[[nodiscard]] std::optional<IntraclassCorrelation> single_agreement(
    const TwoWayMeanSquares& squares, double level = kConfidenceLevel);

/// ICC(2,k), also ICC(A,k): of the mean of as many judges as there are columns.
/// \param level  in (0, 1)
/// \return nothing if its denominator is not positive; no interval if that is so at its lower end
/// \throws std::invalid_argument if the level is out of range
[[nodiscard]] std::optional<IntraclassCorrelation> average_agreement(
    const TwoWayMeanSquares& squares, double level = kConfidenceLevel);

/// ICC(1,1), by a one-way analysis of variance, also of groups that differ in size.
/// \param groups  each the repeats of one thing; those with fewer than two are left out
/// \return in [-1, 1]; nothing with fewer than two such groups, or if all numbers are the same
/// \throws std::invalid_argument if a number is not finite
[[nodiscard]] std::optional<double> one_way_correlation(
    std::span<const std::vector<double>> groups);

/// How far participants agree about the items.
struct Agreement {
  int items = 0;
  int participants = 0;                             ///< who rated all items
  int left_out = 0;                                 ///< the others
  std::optional<TwoWayMeanSquares> mean_squares{};  ///< of items (rows) and participants (columns)
  std::optional<IntraclassCorrelation> single{};    ///< single_agreement
  std::optional<IntraclassCorrelation> average{};   ///< average_agreement
};

/// \param items  as in rating_means
/// \param level  in (0, 1)
/// \throws std::invalid_argument if a rating is not finite, or the level is out of range
[[nodiscard]] Agreement agreement(std::span<const RatedParticipant> participants,
                                  std::span<const Item> items, double level = kConfidenceLevel);

/// Correlations further out count as this one in a mean of Fisher's z, which would be infinite for
/// somebody who repeats every answer.
inline constexpr double kFurthestCorrelation = 0.99;

/// How far participants agree with themselves: ICC(1,1) of each participant's repeats. It is the
/// one-way form because the order of trials is drawn: nothing but time tells a first repeat from a
/// second, and drift over time counts against reliability. It depends on how much the items differ
/// to the participant.
struct RetestReliability {
  std::vector<std::optional<double>> own;  ///< one_way_correlation of each participant's items
  int participants = 0;                    ///< who have one
  int cut = 0;                             ///< of these, beyond kFurthestCorrelation
  Quartiles quartiles{};                   ///< of participants' own correlations, uncut
  std::optional<double> mean{};            ///< by Fisher's z; nothing without participants
  std::optional<Interval> interval{};      ///< t over participants' z; nothing with fewer than two
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

/// Somebody whose answers have a smaller SD, as a share of the scale's length, uses almost none of
/// it.
inline constexpr double kNarrowUse = 0.05;

/// All scored answers of one participant, repeats and items alike.
struct ScaleUse {
  Proportion at_low{};   ///< answers at the lower end, of all
  Proportion at_high{};  ///< at the upper end
  std::optional<double> mean{};
  std::optional<double> sd{};  ///< n - 1; nothing with fewer than two answers
  int distinct = 0;            ///< different values
  bool narrow = false;         ///< the SD is below kNarrowUse of the scale's length
};

struct ScaleUses {
  std::vector<ScaleUse> participants;  ///< in the order given
  Proportion at_low{};                 ///< over everybody's answers
  Proportion at_high{};
  int narrow = 0;  ///< participants
};

/// \param scale  its ends
/// \throws std::invalid_argument if they are not finite and ascending, or a rating lies beyond them
[[nodiscard]] ScaleUses scale_use(std::span<const RatedParticipant> participants,
                                  const Interval& scale);

/// \}
/// \name Methods compared
/// \{

/// Of one test in a family.
struct FamilyP {
  double p = 1.0;
  double holm = 1.0;  ///< holm_adjusted over the pairs that have a p
};

/// A mean difference in units of participants' standard deviation of it.
struct StandardisedDifference {
  double d_z = 0.0;
  std::optional<Interval> interval{};  ///< analysis::effect_interval
  /// Without that assumption, and without most of the bias of d_z: jackknife over participants.
  /// Nothing with fewer than three, or if all differences but one are the same.
  std::optional<JackknifeEstimate> jackknifed{};
};

/// \param differences  one per participant
/// \param level  in (0, 1)
/// \return nothing with fewer than two differences, or if all are the same
/// \throws std::invalid_argument if a difference is not finite, or the level is out of range
[[nodiscard]] std::optional<StandardisedDifference> standardised_difference(
    std::span<const double> differences, double level = kConfidenceLevel);

/// How much higher one method is rated than another. A participant's difference is the mean over
/// the classes that both methods have.
struct MethodDifference {
  int first = 0;                    ///< method
  int second = 0;                   ///< method
  int classes = 0;                  ///< that both have
  MeanEstimate difference;          ///< first less second, in units of the scale
  std::optional<double> t{};        ///< of n - 1 degrees; nothing if all differences are the same
  std::optional<FamilyP> t_test{};  ///< t_test_p, two-sided; nothing without t
  std::optional<FamilyP> sign_flip{};  ///< sign_flip_p; nothing without participants
  std::optional<StandardisedDifference> standardised{};
};

/// All pairs of methods, in ascending order, the lower number first.
/// Arguments and errors are those of rating_means.
[[nodiscard]] std::vector<MethodDifference> method_differences(
    std::span<const RatedParticipant> participants, std::span<const Item> items,
    const Interval& scale, double level = kConfidenceLevel);

/// \}
/// \name Catch trials
/// \{

/// One participant who rated catch trials and scored ones.
struct CatchRating {
  int participant = 0;  ///< place in the order given
  double catches = 0.0;
  double scored = 0.0;  ///< mean over the rated items' means
};

/// Whether people rate what they feel, and not the picture alone: catch trials have nothing to
/// feel.
struct CatchComparison {
  std::vector<CatchRating> participants;
  MeanEstimate catches;     ///< of these participants
  MeanEstimate difference;  ///< scored less catches, in units of the scale
  int not_lower = 0;        ///< participants who rate catch trials at least as high as scored ones
};

/// \param items  that catch trials are compared with; otherwise as in rating_means, errors too
[[nodiscard]] CatchComparison catch_comparison(std::span<const RatedParticipant> participants,
                                               std::span<const Item> items, const Interval& scale,
                                               double level = kConfidenceLevel);

/// \}

}  // namespace touchtrial::analysis::rating

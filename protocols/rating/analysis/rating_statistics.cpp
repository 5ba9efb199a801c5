#include "protocols/rating/analysis/rating_statistics.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/paired_tests.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include <boost/math/distributions/fisher_f.hpp>

namespace touchtrial::analysis::rating {
namespace {

/// One participant's ratings by item.
using Repeats = std::map<Item, std::vector<double>>;

using Items = std::set<Item>;

double length_of(const Interval& scale) {
  return scale.high - scale.low;
}

/// The range of possible differences.
Interval difference_range(const Interval& scale) {
  return {-length_of(scale), length_of(scale)};
}

void require_on_scale(std::span<const RatedParticipant> participants, const Interval& scale) {
  if (!std::isfinite(length_of(scale)) || length_of(scale) <= 0.0) {
    throw std::invalid_argument("a scale needs two ends in ascending order");
  }
  const auto is_on_scale = [&](double value) { return value >= scale.low && value <= scale.high; };
  for (const RatedParticipant& participant : participants) {
    if (!std::ranges::all_of(participant.scored, is_on_scale, &ItemRating::value) ||
        !std::ranges::all_of(participant.catches, is_on_scale)) {
      throw std::invalid_argument("a rating is beyond the ends of its scale");
    }
  }
}

Repeats repeats_of(const RatedParticipant& participant, const Items& items) {
  Repeats repeats;
  for (const ItemRating& rating : participant.scored) {
    if (items.contains(rating.item)) repeats[rating.item].push_back(rating.value);
  }
  return repeats;
}

std::vector<Repeats> repeats_of(std::span<const RatedParticipant> participants,
                                const Items& items) {
  std::vector<Repeats> all;
  for (const RatedParticipant& participant : participants)
    all.push_back(repeats_of(participant, items));
  return all;
}

/// \return a participant's mean of each item; nothing if one is missing
std::optional<std::vector<double>> means_of(const Repeats& repeats, const Items& items) {
  std::vector<double> means;
  for (const Item& item : items) {
    const auto found = repeats.find(item);
    if (found == repeats.end()) return std::nullopt;
    means.push_back(mean_of(found->second));
  }
  return means;
}

/// \return a participant's mean over the items; nothing if one is missing, or there is none
std::optional<double> mean_over(const Repeats& repeats, const Items& items) {
  const auto means = means_of(repeats, items);
  if (!means || means->empty()) return std::nullopt;
  return mean_of(*means);
}

MeanEstimate mean_over(std::span<const Repeats> participants, const Items& items,
                       const Interval& scale, double level) {
  std::vector<double> means;
  for (const Repeats& repeats : participants) {
    if (const auto mean = mean_over(repeats, items)) means.push_back(*mean);
  }
  return participant_mean(means, scale, level);
}

/// Groups items by method or by class.
std::map<int, Items> items_by_group(const Items& items, int Item::*group_member) {
  std::map<int, Items> groups;
  for (const Item& item : items) groups[item.*group_member].insert(item);
  return groups;
}

std::vector<GroupMean> group_means(std::span<const Repeats> participants, const Items& items,
                                   int Item::*group_member, const Interval& scale, double level) {
  std::vector<GroupMean> means;
  for (const auto& [group, members] : items_by_group(items, group_member)) {
    means.push_back(
        {group, static_cast<int>(members.size()), mean_over(participants, members, scale, level)});
  }
  return means;
}

double f_quantile_upper(double degrees, double denominator_degrees, double tail) {
  return quantile(
      complement(boost::math::fisher_f_distribution<>(degrees, denominator_degrees), tail));
}

/// McGraw and Wong's degrees of freedom for the combination of column and residual mean squares at
/// this correlation.
/// \return nothing if less than one
std::optional<double> satterthwaite_degrees(const TwoWayMeanSquares& squares, double correlation) {
  const double n = squares.rows;
  const double k = squares.columns;
  const double columns = k * correlation * squares.between_columns;
  const double residual =
      (n * (1.0 - correlation) + k * correlation * (n - 1.0)) * squares.residual;
  const double denominator = (columns * columns + residual * residual / (n - 1.0)) / (k - 1.0);
  const double sum = columns + residual;
  if (denominator <= 0.0 || sum * sum < denominator) return std::nullopt;
  return sum * sum / denominator;
}

/// The interval of single_agreement.
std::optional<Interval> single_agreement_interval(const TwoWayMeanSquares& squares, double estimate,
                                                  double level) {
  const auto degrees = satterthwaite_degrees(squares, estimate);
  if (!degrees) return std::nullopt;
  const double n = squares.rows;
  const double k = squares.columns;
  const double tail = 0.5 * (1.0 - level);
  const double row_term = n * squares.between_rows;
  const double residual_term = n * squares.residual;
  const double error_term = k * squares.between_columns + (k * n - k - n) * squares.residual;
  const double f_low = f_quantile_upper(n - 1.0, *degrees, tail);
  const double f_high = f_quantile_upper(*degrees, n - 1.0, tail);
  return Interval{(row_term - f_low * residual_term) / (f_low * error_term + row_term),
                  (f_high * row_term - residual_term) / (error_term + f_high * row_term)};
}

/// The Spearman-Brown formula: the reliability of means of k ratings from the reliability of single
/// ratings.
std::optional<double> spearman_brown(double single, double k) {
  const double denominator = 1.0 + (k - 1.0) * single;
  if (denominator <= 0.0) return std::nullopt;
  return k * single / denominator;
}

/// The jackknife estimate of d_z. Nothing if the differences without one person are equal and thus
/// have no d_z.
std::optional<JackknifeEstimate> d_z_jackknife(double d_z, std::span<const double> differences,
                                               double level) {
  if (differences.size() < 3) return std::nullopt;
  std::vector<double> leave_one_out;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    std::vector<double> others(differences.begin(), differences.end());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto statistic = t_statistic_without_interval(others);
    if (!statistic) return std::nullopt;
    leave_one_out.push_back(statistic->d);
  }
  constexpr double kUnbounded = std::numeric_limits<double>::max();
  return jackknife(d_z, leave_one_out, {-kUnbounded, kUnbounded}, level);
}

/// A family with one test.
std::optional<FamilyP> unadjusted(std::optional<double> p) {
  if (!p) return std::nullopt;
  return FamilyP{*p, *p};
}

void adjust(std::span<MethodDifference> pairs, std::optional<FamilyP> MethodDifference::*test) {
  std::vector<double> family;
  for (const MethodDifference& pair : pairs) {
    if (pair.*test) family.push_back((pair.*test)->p);
  }
  const std::vector<double> adjusted = holm_adjusted(family);
  auto next = adjusted.begin();
  for (MethodDifference& pair : pairs) {
    if (pair.*test) (pair.*test)->holm = *next++;
  }
}

/// The items of the first method with a class that the second method has.
Items shared_items(const Items& first, const Items& second) {
  Items shared;
  for (const Item& item : first) {
    if (std::ranges::find(second, item.texture_class, &Item::texture_class) != second.end()) {
      shared.insert(item);
    }
  }
  return shared;
}

MethodDifference difference_of(std::span<const Repeats> participants, const Items& first,
                               const Items& second, const Interval& scale, double level) {
  const Items first_items = shared_items(first, second);
  const Items second_items = shared_items(second, first);
  std::vector<double> differences;
  for (const Repeats& repeats : participants) {
    const auto first_mean = mean_over(repeats, first_items);
    const auto second_mean = mean_over(repeats, second_items);
    if (first_mean && second_mean) differences.push_back(without_noise(*first_mean - *second_mean));
  }
  const auto statistic = t_statistic_without_interval(differences);
  const auto t = statistic ? std::optional(statistic->t) : std::nullopt;
  return {first.begin()->method,
          second.begin()->method,
          static_cast<int>(first_items.size()),
          participant_mean(differences, difference_range(scale), level),
          t,
          unadjusted(t ? t_test_p(differences, 0.0, Sides::two) : std::nullopt),
          unadjusted(sign_flip_p(differences)),
          standardised_difference(differences, level)};
}

ScaleUse use_of(const RatedParticipant& participant, const Interval& scale) {
  std::vector<double> values;
  for (const ItemRating& rating : participant.scored) values.push_back(rating.value);
  const auto n = static_cast<int>(values.size());
  const auto count_at = [&](double end) {
    return static_cast<int>(std::ranges::count_if(
        values, [end](double value) { return without_noise(value - end) == 0.0; }));
  };
  ScaleUse use{.at_low = {n, count_at(scale.low)}, .at_high = {n, count_at(scale.high)}};
  if (n == 0) return use;
  use.mean = mean_of(values);
  if (n > 1) {
    use.sd = without_noise(standard_deviation(values, *use.mean, n - 1.0));
    use.is_narrow = *use.sd < kNarrowUse * length_of(scale);
  }
  std::ranges::sort(values);
  const auto end = std::unique(values.begin(), values.end(),
                               [](double a, double b) { return without_noise(b - a) == 0.0; });
  use.distinct = static_cast<int>(end - values.begin());
  return use;
}

}  // namespace

RatingMeans rating_means(std::span<const RatedParticipant> participants,
                         std::span<const Item> items, const Interval& scale, double level) {
  require_on_scale(participants, scale);
  const Items all(items.begin(), items.end());
  const std::vector<Repeats> repeats = repeats_of(participants, all);
  RatingMeans means;
  for (const Item& item : all) {
    means.items.push_back({item, mean_over(repeats, Items{item}, scale, level)});
  }
  means.methods = group_means(repeats, all, &Item::method, scale, level);
  means.classes = group_means(repeats, all, &Item::texture_class, scale, level);
  return means;
}

std::optional<TwoWayMeanSquares> two_way_mean_squares(std::span<const std::vector<double>> table) {
  const std::size_t columns = table.empty() ? 0 : table.front().size();
  std::vector<double> column_means(columns);
  std::vector<double> row_means;
  for (const std::vector<double>& row : table) {
    require_finite(row, "an analysis of variance");
    if (row.size() != columns) throw std::invalid_argument("a table has equally long rows");
    for (std::size_t j = 0; j < columns; ++j) {
      column_means[j] += row[j] / static_cast<double>(table.size());
    }
    if (columns > 0) row_means.push_back(mean_of(row));
  }
  if (table.size() < 2 || columns < 2) return std::nullopt;
  const double mean = mean_of(row_means);
  double row_squares = 0.0;
  double column_squares = 0.0;
  double residual_squares = 0.0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double row = without_noise(row_means[i] - mean);
    row_squares += row * row;
    for (std::size_t j = 0; j < columns; ++j) {
      const double residual = without_noise(table[i][j] - row_means[i] - column_means[j] + mean);
      residual_squares += residual * residual;
    }
  }
  for (const double column_mean : column_means) {
    const double column = without_noise(column_mean - mean);
    column_squares += column * column;
  }
  const auto n = static_cast<double>(table.size());
  const auto k = static_cast<double>(columns);
  return TwoWayMeanSquares{static_cast<int>(table.size()), static_cast<int>(columns),
                           k * row_squares / (n - 1.0), n * column_squares / (k - 1.0),
                           residual_squares / ((n - 1.0) * (k - 1.0))};
}

std::optional<IntraclassCorrelation> single_agreement(const TwoWayMeanSquares& squares,
                                                      double level) {
  require_level(level);
  const double n = squares.rows;
  const double k = squares.columns;
  const double all =
      n * squares.between_rows + (k * n - k - n) * squares.residual + k * squares.between_columns;
  if (all <= 0.0) return std::nullopt;
  const double estimate = n * (squares.between_rows - squares.residual) / all;
  return IntraclassCorrelation{estimate, single_agreement_interval(squares, estimate, level)};
}

std::optional<IntraclassCorrelation> average_agreement(const TwoWayMeanSquares& squares,
                                                       double level) {
  const auto single = single_agreement(squares, level);
  if (!single) return std::nullopt;
  const double k = squares.columns;
  const auto estimate = spearman_brown(single->estimate, k);
  if (!estimate) return std::nullopt;
  IntraclassCorrelation average{*estimate};
  if (!single->interval) return average;
  const auto low = spearman_brown(single->interval->low, k);
  const auto high = spearman_brown(single->interval->high, k);
  if (low && high) average.interval = Interval{*low, *high};
  return average;
}

std::optional<double> one_way_correlation(std::span<const std::vector<double>> groups) {
  double numbers = 0.0;
  double squared_sizes = 0.0;
  double sum = 0.0;
  double used_groups = 0.0;
  for (const std::vector<double>& group : groups) {
    require_finite(group, "an analysis of variance");
    if (group.size() < 2) continue;
    const auto size = static_cast<double>(group.size());
    numbers += size;
    squared_sizes += size * size;
    sum += size * mean_of(group);
    used_groups += 1.0;
  }
  if (used_groups < 2.0) return std::nullopt;
  double between = 0.0;
  double within = 0.0;
  for (const std::vector<double>& group : groups) {
    if (group.size() < 2) continue;
    const double mean = mean_of(group);
    const double deviation = without_noise(mean - sum / numbers);
    between += static_cast<double>(group.size()) * deviation * deviation;
    for (const double value : group) {
      const double residual = without_noise(value - mean);
      within += residual * residual;
    }
  }
  between /= used_groups - 1.0;
  within /= numbers - used_groups;
  const double size = (numbers - squared_sizes / numbers) / (used_groups - 1.0);
  const double all = between + (size - 1.0) * within;
  if (all <= 0.0) return std::nullopt;
  return (between - within) / all;
}

Agreement agreement(std::span<const RatedParticipant> participants, std::span<const Item> items,
                    double level) {
  require_level(level);
  const Items all(items.begin(), items.end());
  Agreement result{.items = static_cast<int>(all.size())};
  std::vector<std::vector<double>> table(all.size());
  for (const Repeats& repeats : repeats_of(participants, all)) {
    const auto means = means_of(repeats, all);
    if (!means || means->empty()) {
      ++result.left_out;
      continue;
    }
    ++result.participants;
    for (std::size_t i = 0; i < table.size(); ++i) table[i].push_back((*means)[i]);
  }
  result.mean_squares = two_way_mean_squares(table);
  if (!result.mean_squares) return result;
  result.single = single_agreement(*result.mean_squares, level);
  result.average = average_agreement(*result.mean_squares, level);
  return result;
}

RetestReliability retest_reliability(std::span<const RatedParticipant> participants,
                                     std::span<const Item> items, double level) {
  require_level(level);
  RetestReliability result;
  std::vector<double> correlations;
  std::vector<double> z;
  for (const Repeats& repeats : repeats_of(participants, Items(items.begin(), items.end()))) {
    std::vector<std::vector<double>> groups;
    for (const auto& [item, values] : repeats) groups.push_back(values);
    const auto correlation = one_way_correlation(groups);
    result.correlations.push_back(correlation);
    if (!correlation) continue;
    correlations.push_back(*correlation);
    if (std::abs(*correlation) > kMaxCorrelation) ++result.clamped;
    z.push_back(std::atanh(std::clamp(*correlation, -kMaxCorrelation, kMaxCorrelation)));
  }
  result.participants = static_cast<int>(correlations.size());
  result.quartiles = quartiles(correlations);
  const double max_z = std::atanh(kMaxCorrelation);
  const MeanEstimate mean = participant_mean(z, {-max_z, max_z}, level);
  if (mean.mean) result.mean = std::tanh(*mean.mean);
  if (const auto interval = mean.known_interval()) {
    result.interval = Interval{std::tanh(interval->low), std::tanh(interval->high)};
  }
  return result;
}

ScaleUses scale_use(std::span<const RatedParticipant> participants, const Interval& scale) {
  require_on_scale(participants, scale);
  ScaleUses uses;
  for (const RatedParticipant& participant : participants) {
    const ScaleUse use = use_of(participant, scale);
    uses.at_low += use.at_low;
    uses.at_high += use.at_high;
    uses.narrow_count += use.is_narrow ? 1 : 0;
    uses.participants.push_back(use);
  }
  return uses;
}

std::optional<StandardisedDifference> standardised_difference(std::span<const double> differences,
                                                              double level) {
  require_level(level);
  require_finite(differences, "a standardised difference");
  const auto statistic = t_statistic(differences, 0.0, level);
  if (!statistic) return std::nullopt;
  return StandardisedDifference{statistic->d, statistic->interval,
                                d_z_jackknife(statistic->d, differences, level)};
}

std::vector<MethodDifference> method_differences(std::span<const RatedParticipant> participants,
                                                 std::span<const Item> items, const Interval& scale,
                                                 double level) {
  require_on_scale(participants, scale);
  const Items all(items.begin(), items.end());
  const std::vector<Repeats> repeats = repeats_of(participants, all);
  const std::map<int, Items> methods = items_by_group(all, &Item::method);
  std::vector<MethodDifference> pairs;
  for (auto first = methods.begin(); first != methods.end(); ++first) {
    for (auto second = std::next(first); second != methods.end(); ++second) {
      pairs.push_back(difference_of(repeats, first->second, second->second, scale, level));
    }
  }
  adjust(pairs, &MethodDifference::t_test);
  adjust(pairs, &MethodDifference::sign_flip);
  return pairs;
}

CatchComparison catch_comparison(std::span<const RatedParticipant> participants,
                                 std::span<const Item> items, const Interval& scale, double level) {
  require_on_scale(participants, scale);
  const Items all(items.begin(), items.end());
  CatchComparison result;
  std::vector<double> catches;
  std::vector<double> differences;
  for (std::size_t i = 0; i < participants.size(); ++i) {
    std::vector<double> means;
    for (const auto& [item, values] : repeats_of(participants[i], all)) {
      means.push_back(mean_of(values));
    }
    if (means.empty() || participants[i].catches.empty()) continue;
    const CatchRating rating{static_cast<int>(i), mean_of(participants[i].catches), mean_of(means)};
    result.participants.push_back(rating);
    catches.push_back(rating.catches);
    differences.push_back(without_noise(rating.scored - rating.catches));
    if (differences.back() <= 0.0) ++result.not_lower;
  }
  result.catches = participant_mean(catches, scale, level);
  result.difference = participant_mean(differences, difference_range(scale), level);
  return result;
}

}  // namespace touchtrial::analysis::rating

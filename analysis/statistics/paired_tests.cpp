#include "analysis/statistics/paired_tests.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>

namespace touchtrial::analysis {
namespace {

/// Sums that differ by less than this share of the largest possible one are equal except for
/// rounding.
constexpr double kTie = 1e-9;

/// The number of random sign patterns if there are too many to count.
constexpr std::size_t kSampledPatterns = 99'999;

/// The sums of all 2^n sign patterns, ascending.
std::vector<double> sorted_sums(std::span<const double> differences) {
  std::vector<double> sums{0.0};
  for (const double difference : differences) {
    const std::size_t half = sums.size();
    sums.resize(2 * half);
    for (std::size_t i = 0; i < half; ++i) {
      sums[half + i] = sums[i] - difference;
      sums[i] += difference;
    }
  }
  std::sort(sums.begin(), sums.end());
  return sums;
}

/// Counts the patterns with a sum of at least `threshold` without listing them all: as the sum of
/// one half grows, smaller sums of the other half suffice.
double exact_share_at_least(std::span<const double> differences, double threshold) {
  const std::size_t middle = differences.size() / 2;
  const std::vector<double> left = sorted_sums(differences.first(middle));
  const std::vector<double> right = sorted_sums(differences.subspan(middle));
  std::uint64_t count = 0;
  std::size_t first_enough = right.size();
  for (const double sum : left) {
    while (first_enough > 0 && sum + right[first_enough - 1] >= threshold) --first_enough;
    count += right.size() - first_enough;
  }
  return std::ldexp(static_cast<double>(count), -static_cast<int>(differences.size()));
}

std::vector<double> sampled_sums(std::span<const double> differences) {
  constexpr std::array<double, 2> kSign{-1.0, 1.0};
  RandomStream random(0, "sign flips");
  std::vector<double> sums(kSampledPatterns);
  for (double& sum : sums) {
    std::uint64_t signs = 0;
    for (std::size_t k = 0; k < differences.size(); ++k, signs >>= 1U) {
      if (k % 64 == 0) signs = random.bits();
      sum += kSign[signs & 1U] * differences[k];
    }
  }
  return sums;
}

std::vector<double> sampled_distances(std::span<const double> differences) {
  std::vector<double> distances = sampled_sums(differences);
  for (double& distance : distances) distance = std::abs(distance);
  return distances;
}

double share_of_draws_at_least(const std::vector<double>& drawn, double threshold) {
  const auto as_extreme =
      std::count_if(drawn.begin(), drawn.end(), [&](double one) { return one >= threshold; });
  return p_of_draws(static_cast<double>(as_extreme), static_cast<double>(drawn.size()));
}

/// The largest p of any distance that does not exceed the level.
double sampled_attainable(std::span<const double> differences, double level, double tie) {
  std::vector<double> distances = sampled_distances(differences);
  std::sort(distances.begin(), distances.end(), std::greater<>());
  double attainable = 0.0;
  for (std::size_t i = 0; i < distances.size();) {
    const double threshold = distances[i] - tie;
    while (i < distances.size() && distances[i] >= threshold) ++i;
    const double p = p_of_draws(static_cast<double>(i), static_cast<double>(distances.size()));
    if (p > level) break;
    attainable = p;
  }
  return attainable;
}

/// Two-sided p of a sum whose distance from zero is `threshold`.
double two_sided_p(std::span<const double> differences, double threshold) {
  if (differences.size() > kExactSignFlips) {
    return share_of_draws_at_least(sampled_distances(differences), threshold);
  }
  return 2.0 * exact_share_at_least(differences, threshold);
}

/// One-sided p of a sum of `threshold`.
double one_sided_p(std::span<const double> differences, double threshold) {
  return differences.size() > kExactSignFlips
             ? share_of_draws_at_least(sampled_sums(differences), threshold)
             : exact_share_at_least(differences, threshold);
}

/// The largest possible sum.
double largest_sum(std::span<const double> differences) {
  require_finite(differences, "a sign-flip test");
  double max_sum = 0.0;
  for (const double difference : differences) max_sum += std::abs(difference);
  return max_sum;
}

/// The sums over strata that give the estimate and its variance, in the notation of Robins, Breslow
/// and Greenland.
struct StrataSums {
  double r = 0.0, s = 0.0, pr = 0.0, ps_qr = 0.0, qs = 0.0;

  void add(const Proportion& first, const Proportion& second) {
    const double n = static_cast<double>(first.n) + second.n;
    if (n == 0.0) return;
    const double first_wrong = first.n - first.correct;
    const double second_wrong = second.n - second.correct;
    const double p = (first.correct + second_wrong) / n;
    const double q = (first_wrong + second.correct) / n;
    const double stratum_r = first.correct * second_wrong / n;
    const double stratum_s = first_wrong * second.correct / n;
    r += stratum_r;
    s += stratum_s;
    pr += p * stratum_r;
    ps_qr += p * stratum_s + q * stratum_r;
    qs += q * stratum_s;
  }

  [[nodiscard]] double variance_of_log() const {
    return pr / (2.0 * r * r) + ps_qr / (2.0 * r * s) + qs / (2.0 * s * s);
  }
};

/// The indices of p values in ascending order.
std::vector<std::size_t> ascending_order(std::span<const double> p_values) {
  for (const double p : p_values) {
    if (!(p >= 0.0 && p <= 1.0)) throw std::invalid_argument("a p must be in [0, 1]");
  }
  std::vector<std::size_t> ascending(p_values.size());
  std::iota(ascending.begin(), ascending.end(), std::size_t{0});
  std::sort(ascending.begin(), ascending.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  return ascending;
}

using Occasions = std::span<const std::vector<bool>>;
using RightByMethod = std::vector<std::int64_t>;

void require_length(Occasions occasions, std::size_t methods) {
  for (const std::vector<bool>& occasion : occasions) {
    if (occasion.size() != methods) {
      throw std::invalid_argument("Cochran's Q needs one answer per method on every occasion");
    }
  }
}

std::int64_t right_count(const std::vector<bool>& occasion) {
  return std::count(occasion.begin(), occasion.end(), true);
}

bool methods_differ(Occasions occasions) {
  return std::any_of(occasions.begin(), occasions.end(), [](const std::vector<bool>& occasion) {
    const std::int64_t right = right_count(occasion);
    return right > 0 && right < static_cast<std::int64_t>(occasion.size());
  });
}

RightByMethod right_by_method(Occasions occasions, std::size_t methods) {
  RightByMethod right(methods);
  for (const std::vector<bool>& occasion : occasions) {
    for (std::size_t j = 0; j < methods; ++j) right[j] += occasion[j] ? 1 : 0;
  }
  return right;
}

std::int64_t sum_of_squares(const RightByMethod& right) {
  return std::inner_product(right.begin(), right.end(), right.begin(), std::int64_t{0});
}

/// Permutes the methods within every participant.
/// \return the resulting sum of squares
std::int64_t permuted_sum_of_squares(std::vector<RightByMethod>& participants,
                                     RandomStream& random) {
  RightByMethod right(participants.front().size());
  for (RightByMethod& person_counts : participants) {
    shuffle(std::span(person_counts), random);
    for (std::size_t j = 0; j < right.size(); ++j) right[j] += person_counts[j];
  }
  return sum_of_squares(right);
}

}  // namespace

std::optional<double> decibels(double a, double b) {
  if (!(a > 0.0 && b > 0.0)) return std::nullopt;
  return without_noise(10.0 * std::log10(a / b));
}

MethodComparison compare_methods(std::span<const PairedAccuracy> participants, std::uint64_t index,
                                 int draws) {
  std::vector<double> differences;
  double first = 0.0;
  double second = 0.0;
  for (const PairedAccuracy& participant : participants) {
    differences.push_back(without_noise(participant.first - participant.second));
    first += participant.first;
    second += participant.second;
  }
  const MeanEstimate mean = participant_mean(differences, {-1.0, 1.0});
  return {mean.participants,       mean.mean,
          mean.interval,           sign_flip_p(differences),
          decibels(first, second), bootstrap_mean(differences, index, draws),
          t_statistic(differences)};
}

std::optional<double> sign_flip_p(std::span<const double> differences, Sides sides) {
  if (differences.empty()) return std::nullopt;
  const double max_sum = largest_sum(differences);
  const double sum = std::accumulate(differences.begin(), differences.end(), 0.0);
  // Differences of proportions often tie; rounding must not break a tie.
  if (sides == Sides::one) return one_sided_p(differences, sum - kTie * max_sum);
  const double threshold = std::abs(sum) - kTie * max_sum;
  if (threshold <= 0.0) return 1.0;
  return two_sided_p(differences, threshold);
}

double sign_flip_min_p(std::span<const double> differences, Sides sides) {
  const double tie = kTie * largest_sum(differences);
  const auto nonzero = std::ranges::count_if(
      differences, [tie](double difference) { return std::abs(difference) > tie; });
  if (nonzero == 0) return 1.0;
  if (differences.size() > kExactSignFlips) {
    return p_of_draws(0.0, static_cast<double>(kSampledPatterns));
  }
  return std::ldexp(sides == Sides::one ? 1.0 : 2.0, -static_cast<int>(nonzero));
}

double sign_flip_attainable(std::span<const double> differences, double level) {
  const double max_sum = largest_sum(differences);
  if (max_sum > 0.0 && differences.size() > kExactSignFlips) {
    return sampled_attainable(differences, level, kTie * max_sum);
  }
  double rejected = max_sum * (1.0 - kTie);
  if (max_sum == 0.0 || two_sided_p(differences, rejected) > level) return 0.0;
  double retained = 0.0;
  while (rejected - retained > kTie * max_sum) {
    const double middle = 0.5 * (rejected + retained);
    (two_sided_p(differences, middle) <= level ? rejected : retained) = middle;
  }
  return two_sided_p(differences, rejected);
}

std::optional<OddsRatio> mantel_haenszel(
    std::span<const std::pair<Proportion, Proportion>> participants, double level) {
  require_level(level);
  StrataSums sums;
  for (const auto& [first, second] : participants) {
    require_possible(first);
    require_possible(second);
    sums.add(first, second);
  }
  if (sums.r == 0.0 || sums.s == 0.0) return std::nullopt;
  const double estimate = sums.r / sums.s;
  const double z = boost::math::quantile(boost::math::normal_distribution<>(), 0.5 + level / 2.0);
  const double factor = std::exp(z * std::sqrt(sums.variance_of_log()));
  return OddsRatio{estimate, {estimate / factor, estimate * factor}};
}

std::optional<Interval> odds_ratio_bootstrap(
    std::span<const std::pair<Proportion, Proportion>> participants, std::uint64_t index, int draws,
    double level) {
  std::vector<Ratio> parts;
  for (const auto& [first, second] : participants) {
    require_possible(first);
    require_possible(second);
    StrataSums sums;
    sums.add(first, second);
    parts.push_back({sums.r, sums.s});
  }
  return bootstrap_ratio(parts, index, draws, level);
}

double mcnemar_mid_p(int first_only, int second_only) {
  if (first_only < 0 || second_only < 0) {
    throw std::invalid_argument("McNemar's test needs counts of 0 or more");
  }
  const int pairs = first_only + second_only;
  if (pairs == 0) return 1.0;
  const boost::math::binomial_distribution<> half(pairs, 0.5);
  const int smaller_count = std::min(first_only, second_only);
  const double tie_probability = boost::math::pdf(half, smaller_count);
  if (first_only == second_only) return 1.0 - 0.5 * tie_probability;  // this outcome counts once
  return 2.0 * boost::math::cdf(half, smaller_count) - tie_probability;
}

std::optional<CochranQ> cochran_q(Occasions occasions) {
  if (occasions.empty()) return std::nullopt;
  const std::size_t methods = occasions.front().size();
  require_length(occasions, methods);
  if (methods < 2 || !methods_differ(occasions)) return std::nullopt;
  const RightByMethod right = right_by_method(occasions, methods);
  const std::int64_t total = std::accumulate(right.begin(), right.end(), std::int64_t{0});
  std::int64_t squares_of_occasions = 0;
  for (const std::vector<bool>& occasion : occasions) {
    squares_of_occasions += right_count(occasion) * right_count(occasion);
  }
  const auto k = static_cast<std::int64_t>(methods);
  const auto between = static_cast<double>(k * sum_of_squares(right) - total * total);
  CochranQ result;
  result.degrees_of_freedom = static_cast<int>(k - 1);
  result.q =
      result.degrees_of_freedom * between / static_cast<double>(k * total - squares_of_occasions);
  const boost::math::chi_squared_distribution<> chi_squared(result.degrees_of_freedom);
  result.p = boost::math::cdf(boost::math::complement(chi_squared, result.q));
  return result;
}

std::optional<double> cochran_q_permuted_p(
    std::span<const std::vector<std::vector<bool>>> by_participant, int deals,
    std::uint64_t index) {
  if (deals < 1) throw std::invalid_argument("a permutation test needs at least one deal");
  std::optional<std::size_t> methods;
  std::vector<RightByMethod> participants;
  bool any_difference = false;
  for (const std::vector<std::vector<bool>>& occasions : by_participant) {
    if (occasions.empty()) continue;
    if (!methods) methods = occasions.front().size();
    require_length(occasions, *methods);
    participants.push_back(right_by_method(occasions, *methods));
    any_difference = any_difference || methods_differ(occasions);
  }
  if (!methods || *methods < 2 || !any_difference) return std::nullopt;
  // Exchanging methods changes only one term of Q, the sum of the methods' squares.
  RightByMethod observed(*methods);
  for (const RightByMethod& person_counts : participants) {
    for (std::size_t j = 0; j < *methods; ++j) observed[j] += person_counts[j];
  }
  const std::int64_t threshold = sum_of_squares(observed);
  RandomStream random(0, "Cochran's Q", index);
  int as_extreme = 0;
  for (int deal = 0; deal < deals; ++deal) {
    if (permuted_sum_of_squares(participants, random) >= threshold) ++as_extreme;
  }
  return p_of_draws(as_extreme, deals);
}

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  const std::vector<std::size_t> ascending = ascending_order(p_values);
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < ascending.size(); ++rank) {
    const auto hypotheses_left = static_cast<double>(ascending.size() - rank);
    largest = std::max(largest, std::min(1.0, hypotheses_left * p_values[ascending[rank]]));
    adjusted[ascending[rank]] = largest;
  }
  return adjusted;
}

std::vector<double> benjamini_hochberg_adjusted(std::span<const double> p_values) {
  const std::vector<std::size_t> ascending = ascending_order(p_values);
  const auto hypotheses = static_cast<double>(ascending.size());
  std::vector<double> adjusted(p_values.size());
  double smallest = 1.0;
  for (std::size_t rank = ascending.size(); rank > 0; --rank) {
    const std::size_t place = ascending[rank - 1];
    smallest = std::min(smallest, hypotheses * p_values[place] / static_cast<double>(rank));
    adjusted[place] = smallest;
  }
  return adjusted;
}

}  // namespace touchtrial::analysis

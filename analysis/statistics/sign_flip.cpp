#include "analysis/statistics/sign_flip.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace touchtrial::analysis {
namespace {

/// Sums that differ by less than this share of the largest possible one are equal but for rounding.
constexpr double kTie = 1e-9;

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

/// Counts the patterns with a sum of at least `threshold` without listing them all: as one half's
/// sum grows, ever smaller sums of the other half will do.
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

/// How far from zero the sums of random patterns are.
std::vector<double> sampled_distances(std::span<const double> differences) {
  constexpr std::size_t kPatterns = 99'999;
  constexpr std::array<double, 2> kSign{-1.0, 1.0};
  RandomStream random(0, "sign flips");
  std::vector<double> distances(kPatterns);
  for (double& distance : distances) {
    double sum = 0.0;
    std::uint64_t signs = 0;
    for (std::size_t k = 0; k < differences.size(); ++k, signs >>= 1U) {
      if (k % 64 == 0) signs = random.bits();
      sum += kSign[signs & 1U] * differences[k];
    }
    distance = std::abs(sum);
  }
  return distances;
}

double share_as_far(const std::vector<double>& distances, double threshold) {
  const auto as_far = std::count_if(distances.begin(), distances.end(),
                                    [&](double distance) { return distance >= threshold; });
  return (static_cast<double>(as_far) + 1.0) / (static_cast<double>(distances.size()) + 1.0);
}

/// The largest p of any distance that does not pass the level.
double sampled_attainable(std::span<const double> differences, double level, double tie) {
  std::vector<double> distances = sampled_distances(differences);
  std::sort(distances.begin(), distances.end(), std::greater<>());
  double attainable = 0.0;
  for (std::size_t i = 0; i < distances.size();) {
    const double threshold = distances[i] - tie;
    while (i < distances.size() && distances[i] >= threshold) ++i;
    const double p = (static_cast<double>(i) + 1.0) / (static_cast<double>(distances.size()) + 1.0);
    if (p > level) break;
    attainable = p;
  }
  return attainable;
}

/// Two-sided p of a sum that is `threshold` away from zero.
double two_sided_p(std::span<const double> differences, double threshold) {
  if (differences.size() > kExactSignFlips) {
    return share_as_far(sampled_distances(differences), threshold);
  }
  return 2.0 * exact_share_at_least(differences, threshold);
}

/// The largest sum that there can be.
double total_size(std::span<const double> differences) {
  double size = 0.0;
  for (const double difference : differences) {
    if (!std::isfinite(difference)) {
      throw std::invalid_argument("a sign-flip test needs finite differences");
    }
    size += std::abs(difference);
  }
  return size;
}

}  // namespace

std::optional<double> sign_flip_p(std::span<const double> differences) {
  if (differences.empty()) return std::nullopt;
  const double size = total_size(differences);
  const double sum = std::accumulate(differences.begin(), differences.end(), 0.0);
  // Differences of proportions tie all the time; rounding must not break a tie.
  const double threshold = std::abs(sum) - kTie * size;
  if (threshold <= 0.0) return 1.0;
  return two_sided_p(differences, threshold);
}

double sign_flip_attainable(std::span<const double> differences, double level) {
  const double size = total_size(differences);
  if (size > 0.0 && differences.size() > kExactSignFlips) {
    return sampled_attainable(differences, level, kTie * size);
  }
  double enough = size * (1.0 - kTie);
  if (size == 0.0 || two_sided_p(differences, enough) > level) return 0.0;
  double too_little = 0.0;
  while (enough - too_little > kTie * size) {
    const double middle = 0.5 * (enough + too_little);
    (two_sided_p(differences, middle) <= level ? enough : too_little) = middle;
  }
  return two_sided_p(differences, enough);
}

}  // namespace touchtrial::analysis

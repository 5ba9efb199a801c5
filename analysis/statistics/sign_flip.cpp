#include "analysis/statistics/sign_flip.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

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

double sampled_two_sided(std::span<const double> differences, double threshold) {
  constexpr int kPatterns = 99'999;
  constexpr std::array<double, 2> kSign{-1.0, 1.0};
  RandomStream random(0, "sign flips");
  int as_far = 0;
  for (int i = 0; i < kPatterns; ++i) {
    double sum = 0.0;
    std::uint64_t signs = 0;
    for (std::size_t k = 0; k < differences.size(); ++k, signs >>= 1U) {
      if (k % 64 == 0) signs = random.bits();
      sum += kSign[signs & 1U] * differences[k];
    }
    if (std::abs(sum) >= threshold) ++as_far;
  }
  return (as_far + 1.0) / (kPatterns + 1.0);
}

}  // namespace

std::optional<double> sign_flip_p(std::span<const double> differences) {
  if (differences.empty()) return std::nullopt;
  double sum = 0.0;
  double size = 0.0;
  for (const double difference : differences) {
    if (!std::isfinite(difference)) {
      throw std::invalid_argument("a sign-flip test needs finite differences");
    }
    sum += difference;
    size += std::abs(difference);
  }
  // Differences of proportions tie all the time; rounding must not break a tie.
  const double threshold = std::abs(sum) - 1e-9 * size;
  if (threshold <= 0.0) return 1.0;
  if (differences.size() > kExactSignFlips) return sampled_two_sided(differences, threshold);
  return 2.0 * exact_share_at_least(differences, threshold);
}

}  // namespace touchtrial

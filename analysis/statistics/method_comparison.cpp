#include "analysis/statistics/method_comparison.hpp"

#include "analysis/statistics/cluster_bootstrap.hpp"
#include "analysis/statistics/rounding_noise.hpp"
#include "analysis/statistics/sign_flip.hpp"

#include <cmath>
#include <vector>

namespace touchtrial::analysis {

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
          decibels(first, second), bootstrap_mean(differences, index, draws)};
}

}  // namespace touchtrial::analysis

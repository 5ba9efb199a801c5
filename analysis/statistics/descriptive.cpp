#include "analysis/statistics/descriptive.hpp"

#include "analysis/statistics/common.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/math/distributions/students_t.hpp>

namespace touchtrial::analysis {

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double standard_deviation(std::span<const double> values, double mean, double divisor) {
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / divisor);
}

bool all_alike(std::span<const double> values) {
  if (values.size() < 2) return false;
  const auto n = static_cast<double>(values.size());
  return without_noise(standard_deviation(values, mean_of(values), n - 1.0)) == 0.0;
}

MeanEstimate participant_mean(std::span<const double> values, Interval range, double level) {
  require_level(level);
  require_finite(values, "a mean");
  MeanEstimate estimate{static_cast<int>(values.size()), std::nullopt, range};
  if (values.empty()) return estimate;
  const double mean = without_noise(mean_of(values));
  estimate.mean = mean;
  if (values.size() == 1) return estimate;
  const auto n = static_cast<double>(values.size());
  const double sd = without_noise(standard_deviation(values, mean, n - 1.0));
  estimate.sd = sd;
  const boost::math::students_t_distribution<> t(n - 1.0);
  const double half_width = boost::math::quantile(t, 0.5 + level / 2.0) * sd / std::sqrt(n);
  estimate.interval = {std::clamp(without_noise(mean - half_width), range.low, range.high),
                       std::clamp(without_noise(mean + half_width), range.low, range.high)};
  return estimate;
}

std::optional<double> quantile(std::span<const double> sorted, double share) {
  if (!(share >= 0.0 && share <= 1.0)) {
    throw std::invalid_argument("a quantile's share must be in [0, 1]");
  }
  if (sorted.empty()) return std::nullopt;
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 == sorted.size()) return sorted.back();
  const double part = place - static_cast<double>(below);
  return sorted[below] + part * (sorted[below + 1] - sorted[below]);
}

Quartiles quartiles(std::vector<double> values) {
  require_finite(values, "a median");
  std::sort(values.begin(), values.end());
  return {static_cast<int>(values.size()), quantile(values, 0.25), quantile(values, 0.5),
          quantile(values, 0.75)};
}

}  // namespace touchtrial::analysis

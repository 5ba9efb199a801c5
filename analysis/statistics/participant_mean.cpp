#include "analysis/statistics/participant_mean.hpp"

#include "analysis/statistics/rounding_noise.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/math/distributions/students_t.hpp>

namespace touchtrial::analysis {
namespace {

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Of the sample, around its mean, with n - 1.
double standard_deviation(std::span<const double> values, double mean) {
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

}  // namespace

MeanEstimate participant_mean(std::span<const double> values, Interval range, double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("a confidence level lies between 0 and 1");
  }
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    throw std::invalid_argument("a mean needs finite values");
  }
  MeanEstimate estimate{static_cast<int>(values.size()), std::nullopt, range};
  if (values.empty()) return estimate;
  const double mean = without_noise(mean_of(values));
  estimate.mean = mean;
  if (values.size() == 1) return estimate;
  const double sd = without_noise(standard_deviation(values, mean));
  estimate.sd = sd;
  const auto n = static_cast<double>(values.size());
  const boost::math::students_t_distribution<> t(n - 1.0);
  const double half = boost::math::quantile(t, 0.5 + level / 2.0) * sd / std::sqrt(n);
  estimate.interval = {std::clamp(without_noise(mean - half), range.low, range.high),
                       std::clamp(without_noise(mean + half), range.low, range.high)};
  return estimate;
}

}  // namespace touchtrial::analysis

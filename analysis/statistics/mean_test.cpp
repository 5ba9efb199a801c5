#include "analysis/statistics/mean_test.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/roots.hpp>

namespace touchtrial::analysis {
namespace {

double equal_values_p(double distance, std::size_t n, Sides sides) {
  if (distance == 0.0 || (sides == Sides::one && distance < 0.0)) return 1.0;
  return std::ldexp(sides == Sides::one ? 1.0 : 2.0, -static_cast<int>(n));
}

/// The noncentrality at which P(T < t) = share.
double noncentrality(double t, double degrees, double share) {
  const auto excess = [&](double delta) {
    return cdf(boost::math::non_central_t_distribution<>(degrees, delta), t) - share;
  };
  const double step = 1.0 + std::abs(t);
  double low = t - step;
  while (excess(low) < 0.0) low -= step;
  double high = t + step;
  while (excess(high) > 0.0) high += step;
  std::uintmax_t steps = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(
      excess, low, high, boost::math::tools::eps_tolerance<double>(45), steps);
  return 0.5 * (a + b);
}

}  // namespace

std::optional<TStatistic> t_statistic_without_interval(std::span<const double> values,
                                                       double null) {
  require_finite(values, "a t statistic");
  require_finite(std::span(&null, 1), "a t statistic");
  if (values.size() < 2 || all_alike(values)) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double mean = mean_of(values);
  const double error = standard_deviation(values, mean, n - 1.0) / std::sqrt(n);
  const double t = without_noise(mean - null) / error;
  return TStatistic{t, static_cast<int>(values.size()) - 1, t / std::sqrt(n)};
}

std::optional<Interval> effect_interval(const TStatistic& statistic, double level) {
  require_level(level);
  if (std::abs(statistic.t) > kMaxT) return std::nullopt;
  const double degrees = statistic.degrees_of_freedom;
  const double root = std::sqrt(degrees + 1.0);
  const double tail = 0.5 * (1.0 - level);
  return Interval{noncentrality(statistic.t, degrees, 1.0 - tail) / root,
                  noncentrality(statistic.t, degrees, tail) / root};
}

std::optional<TStatistic> t_statistic(std::span<const double> values, double null, double level) {
  std::optional<TStatistic> statistic = t_statistic_without_interval(values, null);
  if (statistic) statistic->interval = effect_interval(*statistic, level);
  return statistic;
}

std::optional<double> t_test_p(std::span<const double> values, double null, Sides sides) {
  require_finite(values, "a t test");
  require_finite(std::span(&null, 1), "a t test");
  if (values.size() < 2) return std::nullopt;
  const std::optional<TStatistic> statistic = t_statistic_without_interval(values, null);
  if (!statistic) {
    return equal_values_p(without_noise(mean_of(values) - null), values.size(), sides);
  }
  const boost::math::students_t_distribution<> distribution(statistic->degrees_of_freedom);
  const double t = statistic->t;
  if (sides == Sides::one) return cdf(complement(distribution, t));
  return std::min(1.0, 2.0 * cdf(complement(distribution, std::abs(t))));
}

}  // namespace touchtrial::analysis

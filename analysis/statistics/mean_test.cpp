#include "analysis/statistics/mean_test.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace touchtrial::analysis {
namespace {

/// The p of values that are all at the same distance from the null hypothesis.
double p_of_equals(double distance, std::size_t n, Sides sides) {
  if (distance == 0.0 || (sides == Sides::one && distance < 0.0)) return 1.0;
  return std::ldexp(sides == Sides::one ? 1.0 : 2.0, -static_cast<int>(n));
}

}  // namespace

std::optional<double> t_test_p(std::span<const double> values, double null, Sides sides) {
  require_finite(values, "a t test");
  require_finite(std::span(&null, 1), "a t test");
  if (values.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const double mean = mean_of(values);
  const double distance = without_noise(mean - null);
  if (all_alike(values)) return p_of_equals(distance, values.size(), sides);
  const double sd = standard_deviation(values, mean, n - 1.0);
  const boost::math::students_t_distribution<> distribution(n - 1.0);
  const double t = distance / (sd / std::sqrt(n));
  if (sides == Sides::one) return cdf(complement(distribution, t));
  return std::min(1.0, 2.0 * cdf(complement(distribution, std::abs(t))));
}

}  // namespace touchtrial::analysis

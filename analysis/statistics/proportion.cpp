#include "analysis/statistics/proportion.hpp"

#include "analysis/statistics/common.hpp"

#include <cmath>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>

namespace touchtrial::analysis {
namespace {

void require_interval_arguments(Proportion proportion, double level) {
  require_possible(proportion);
  require_level(level);
}

double beta_quantile(double a, double b, double probability) {
  return boost::math::quantile(boost::math::beta_distribution<>(a, b), probability);
}

}  // namespace

std::optional<double> Proportion::share() const noexcept {
  if (n == 0) return std::nullopt;
  return static_cast<double>(correct) / n;
}

Interval wilson_interval(Proportion proportion, double level) {
  require_interval_arguments(proportion, level);
  if (proportion.n == 0) return {};
  const double n = proportion.n;
  const double p = proportion.correct / n;
  const double z = boost::math::quantile(boost::math::normal_distribution<>(), 0.5 + level / 2.0);
  const double scale = 1.0 + z * z / n;
  const double centre = (p + z * z / (2.0 * n)) / scale;
  const double half_width = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n)) / scale;
  // At 0 and n, centre and half-width differ only by rounding.
  return {proportion.correct == 0 ? 0.0 : centre - half_width,
          proportion.correct == proportion.n ? 1.0 : centre + half_width};
}

Interval clopper_pearson_interval(Proportion proportion, double level) {
  require_interval_arguments(proportion, level);
  if (proportion.n == 0) return {};
  const double tail = (1.0 - level) / 2.0;
  const double correct = proportion.correct;
  const double wrong = proportion.n - proportion.correct;
  return {proportion.correct == 0 ? 0.0 : beta_quantile(correct, wrong + 1.0, tail),
          wrong == 0.0 ? 1.0 : beta_quantile(correct + 1.0, wrong, 1.0 - tail)};
}

Interval jeffreys_interval(Proportion proportion, double level) {
  require_interval_arguments(proportion, level);
  if (proportion.n == 0) return {};
  const double tail = (1.0 - level) / 2.0;
  const double a = proportion.correct + 0.5;
  const double b = proportion.n - proportion.correct + 0.5;
  return {proportion.correct == 0 ? 0.0 : beta_quantile(a, b, tail),
          proportion.correct == proportion.n ? 1.0 : beta_quantile(a, b, 1.0 - tail)};
}

}  // namespace touchtrial::analysis

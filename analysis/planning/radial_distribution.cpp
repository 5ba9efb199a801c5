#include "analysis/planning/radial_distribution.hpp"

#include <cmath>
#include <stdexcept>

#include <boost/math/distributions/chi_squared.hpp>

namespace touchtrial::planning {
namespace {

constexpr int kCells = 2048;
/// Lengths beyond sqrt(d) + this come once in 10^16.
constexpr double kFarTail = 8.5;

}  // namespace

RadialDistribution::RadialDistribution(int dimensions) {
  if (dimensions < 1) throw std::invalid_argument("RadialDistribution: dimensions start at 1");
  reach_ = std::sqrt(static_cast<double>(dimensions)) + kFarTail;
  step_ = reach_ / kCells;
  const boost::math::chi_squared squared(dimensions);
  for (int i = 0; i <= kCells; ++i) {
    const double r = i * step_;
    beyond_.push_back(boost::math::cdf(boost::math::complement(squared, r * r)));
    // The density of r is 2 r times that of its square, whose limit at 0 is finite for d = 1 alone.
    const double near = r > 0.0 ? r : 1e-9 * step_;
    density_.push_back(2.0 * near * boost::math::pdf(squared, near * near) * step_);
  }
}

RadialDistribution::Value RadialDistribution::at(double t) const noexcept {
  const double r = std::abs(t);
  if (!(r < reach_)) return {t > 0.0 ? 1.0 : 0.0, 0.0};
  const int cell = static_cast<int>(r / step_);
  const double x = r / step_ - cell;
  const double from = beyond_[cell];
  const double to = beyond_[cell + 1];
  const double slope_from = -density_[cell];
  const double slope_to = -density_[cell + 1];
  // Cubic Hermite, and its derivative.
  const double c2 = 3.0 * (to - from) - 2.0 * slope_from - slope_to;
  const double c3 = 2.0 * (from - to) + slope_from + slope_to;
  const double more = from + x * (slope_from + x * (c2 + x * c3));
  const double density = -(slope_from + x * (2.0 * c2 + 3.0 * x * c3)) / step_;
  return {t > 0.0 ? 1.0 - 0.5 * more : 0.5 * more, 0.5 * density};
}

}  // namespace touchtrial::planning

#include "analysis/statistics/same_different_d_prime.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace touchtrial::analysis {
namespace {

/// No share of answers needs a larger d'.
constexpr double kMaxDistance = 50.0;

double area_below(double z) {
  return boost::math::cdf(boost::math::normal_distribution<>(), z);
}

double z_of(double share) {
  return boost::math::quantile(boost::math::normal_distribution<>(), share);
}

void require_shares(const SameDifferent& shares) {
  const auto inside = [](double share) { return share > 0.0 && share < 1.0; };
  if (!inside(shares.hits) || !inside(shares.false_alarms)) {
    throw std::invalid_argument("shares of \"different\" must be in (0, 1)");
  }
}

/// The argument at which a function that rises from 0 reaches `share`.
template <typename Rising>
double distance_with(const Rising& share_of, double share) {
  std::uintmax_t most_steps = 200;
  const auto excess = [&](double d) { return share_of(d) - share; };
  const double most = excess(kMaxDistance);
  if (most <= 0.0) return kMaxDistance;
  const double least = excess(0.0);
  if (least >= 0.0) return 0.0;
  const std::pair<double, double> bracket =
      boost::math::tools::toms748_solve(excess, 0.0, kMaxDistance, least, most,
                                        boost::math::tools::eps_tolerance<double>(44), most_steps);
  return std::midpoint(bracket.first, bracket.second);
}

}  // namespace

std::optional<SameDifferentFit> differencing_d_prime(const SameDifferent& shares) {
  require_shares(shares);
  if (shares.hits < shares.false_alarms) return std::nullopt;
  const double k = -std::numbers::sqrt2 * z_of(0.5 * shares.false_alarms);
  const auto hits = [&](double d) {
    return area_below((d - k) / std::numbers::sqrt2) + area_below((-d - k) / std::numbers::sqrt2);
  };
  return SameDifferentFit{distance_with(hits, shares.hits), k};
}

std::optional<SameDifferentFit> independent_d_prime(const SameDifferent& shares) {
  require_shares(shares);
  if (shares.hits < shares.false_alarms) return std::nullopt;
  const double z_hits = z_of(shares.hits);
  const double z_false = z_of(shares.false_alarms);
  // 2 Phi(x) - 1 = erf(x / sqrt 2), without subtraction.
  const double above_chance = std::erf(0.5 * (z_hits - z_false) / std::numbers::sqrt2);
  const double one = 0.5 * (1.0 + std::sqrt(above_chance));
  const double d = one < 1.0 ? 2.0 * z_of(one) : kMaxDistance;
  return SameDifferentFit{d, -0.5 * (z_hits + z_false)};
}

}  // namespace touchtrial::analysis

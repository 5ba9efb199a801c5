#include "analysis/statistics/same_or_odd.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace touchtrial::analysis {
namespace {

/// No share of answers needs a larger d'.
constexpr double kLargestDistance = 50.0;
/// Beyond this distance from its mean a normal density is 0 in double precision.
constexpr double kFarEnd = 12.0;

double area_below(double z) {
  return boost::math::cdf(boost::math::normal_distribution<>(), z);
}

double z_of(double share) {
  return boost::math::quantile(boost::math::normal_distribution<>(), share);
}

void require_shares(const SameDifferent& shares) {
  const auto inside = [](double share) { return share > 0.0 && share < 1.0; };
  if (!inside(shares.hits) || !inside(shares.false_alarms)) {
    throw std::invalid_argument("shares of \"different\" lie between 0 and 1, exclusive");
  }
}

/// Where a function that rises from 0 reaches `share`.
template <typename Rising>
double distance_with(const Rising& share_of, double share) {
  std::uintmax_t most_steps = 200;
  const auto excess = [&](double d) { return share_of(d) - share; };
  const double most = excess(kLargestDistance);
  if (most <= 0.0) return kLargestDistance;
  const double least = excess(0.0);
  if (least >= 0.0) return 0.0;
  const std::pair<double, double> bracket =
      boost::math::tools::toms748_solve(excess, 0.0, kLargestDistance, least, most,
                                        boost::math::tools::eps_tolerance<double>(44), most_steps);
  return std::midpoint(bracket.first, bracket.second);
}

/// The integral of the normal density times `weight` over [low, high].
template <typename Weight>
double normal_integral(const Weight& weight, double low, double high) {
  const auto integrand = [&](double z) {
    return boost::math::pdf(boost::math::normal_distribution<>(), z) * weight(z);
  };
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(integrand, low, high, 10,
                                                                       1e-12);
}

/// Frijters, Kooistra, Vereijken 1980.
double differencing_share(double d) {
  const double shift = d * std::sqrt(2.0 / 3.0);
  const auto weight = [&](double z) {
    return area_below(-z * std::numbers::sqrt3 + shift) +
           area_below(-z * std::numbers::sqrt3 - shift);
  };
  return 2.0 * normal_integral(weight, 0.0, kFarEnd);
}

/// The integrals over the odd impression X = d / 2 + u, below and above 0.
double independent_share(double d) {
  const double half = 0.5 * d;
  const double zero = std::clamp(-half, -kFarEnd, kFarEnd);  // u where X = 0
  const auto square = [](double share) { return share * share; };
  const auto below = [&](double u) {
    return square(area_below(u + d)) + square(area_below(-half));
  };
  const auto above = [&](double u) {
    return square(area_below(half)) + square(area_below(-u - d));
  };
  return normal_integral(below, -kFarEnd, zero) + normal_integral(above, zero, kFarEnd);
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
  const double d = one < 1.0 ? 2.0 * z_of(one) : kLargestDistance;
  return SameDifferentFit{d, -0.5 * (z_hits + z_false)};
}

double odd_one_share_of(double d_prime, OddOneRule rule) {
  if (!std::isfinite(d_prime)) throw std::invalid_argument("d' must be finite");
  const double d = std::min(std::abs(d_prime), kLargestDistance);
  const double share =
      rule == OddOneRule::differencing ? differencing_share(d) : independent_share(d);
  return std::clamp(share, 1.0 / 3.0, 1.0);
}

std::optional<double> odd_one_d_prime(double share, OddOneRule rule) {
  if (!(share >= 0.0 && share <= 1.0)) {
    throw std::invalid_argument("a share correct lies between 0 and 1");
  }
  if (share >= 1.0) return std::nullopt;
  return distance_with([rule](double d) { return odd_one_share_of(d, rule); }, share);
}

}  // namespace touchtrial::analysis

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

/// Larger d' cannot be distinguished from shares of answers.
constexpr double kMaxDPrimeOfShares = 50.0;

double normal_cdf(double z) {
  return boost::math::cdf(boost::math::normal_distribution<>(), z);
}

double z_of(double share) {
  return boost::math::quantile(boost::math::normal_distribution<>(), share);
}

void require_shares(const SameDifferent& shares) {
  const auto is_in_range = [](double share) { return share > 0.0 && share < 1.0; };
  if (!is_in_range(shares.hits) || !is_in_range(shares.false_alarms)) {
    throw std::invalid_argument("shares of \"different\" must be in (0, 1)");
  }
}

/// The argument at which a function that increases from 0 reaches `share`.
template <typename Rising>
double argument_at(const Rising& share_of, double share) {
  std::uintmax_t most_steps = 200;
  const auto excess = [&](double d) { return share_of(d) - share; };
  const double excess_at_max = excess(kMaxDPrimeOfShares);
  if (excess_at_max <= 0.0) return kMaxDPrimeOfShares;
  const double excess_at_zero = excess(0.0);
  if (excess_at_zero >= 0.0) return 0.0;
  const std::pair<double, double> bracket = boost::math::tools::toms748_solve(
      excess, 0.0, kMaxDPrimeOfShares, excess_at_zero, excess_at_max,
      boost::math::tools::eps_tolerance<double>(44), most_steps);
  return std::midpoint(bracket.first, bracket.second);
}

}  // namespace

std::optional<SameDifferentFit> differencing_d_prime(const SameDifferent& shares) {
  require_shares(shares);
  if (shares.hits < shares.false_alarms) return std::nullopt;
  const double k = -std::numbers::sqrt2 * z_of(0.5 * shares.false_alarms);
  const auto hits = [&](double d) {
    return normal_cdf((d - k) / std::numbers::sqrt2) + normal_cdf((-d - k) / std::numbers::sqrt2);
  };
  return SameDifferentFit{argument_at(hits, shares.hits), k};
}

std::optional<SameDifferentFit> independent_d_prime(const SameDifferent& shares) {
  require_shares(shares);
  if (shares.hits < shares.false_alarms) return std::nullopt;
  const double z_hits = z_of(shares.hits);
  const double z_false = z_of(shares.false_alarms);
  // 2 Phi(x) - 1 = erf(x / sqrt 2), without subtraction.
  const double above_chance = std::erf(0.5 * (z_hits - z_false) / std::numbers::sqrt2);
  const double single_correct = 0.5 * (1.0 + std::sqrt(above_chance));
  const double d = single_correct < 1.0 ? 2.0 * z_of(single_correct) : kMaxDPrimeOfShares;
  return SameDifferentFit{d, -0.5 * (z_hits + z_false)};
}

}  // namespace touchtrial::analysis

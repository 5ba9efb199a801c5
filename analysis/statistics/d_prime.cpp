#include "analysis/statistics/d_prime.hpp"

#include "analysis/statistics/common.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/trapezoidal.hpp>
#include <boost/math/tools/toms748_solve.hpp>

namespace touchtrial::analysis {

std::optional<double> type_2_area(std::span<const RatedAnswer> answers) {
  std::map<int, std::pair<std::int64_t, std::int64_t>> by_rating;  // right, wrong
  for (const RatedAnswer& one : answers) {
    auto& [right, wrong] = by_rating[one.rating];
    ++(one.correct ? right : wrong);
  }
  std::int64_t all_right = 0;
  std::int64_t lower_wrong = 0;
  std::int64_t doubled_wins = 0;
  for (const auto& [rating, counts] : by_rating) {
    const auto& [right, wrong] = counts;
    doubled_wins += right * (2 * lower_wrong + wrong);
    all_right += right;
    lower_wrong += wrong;
  }
  if (all_right == 0 || lower_wrong == 0) return std::nullopt;
  return 0.5 * static_cast<double>(doubled_wins) / static_cast<double>(all_right * lower_wrong);
}

namespace {

/// Beyond this distance from the mean a normal density is 0 in double precision.
constexpr double kIntegrationLimit = 12.0;
/// Above this, the normal distribution function is 1 in double precision.
constexpr double kCertain = 8.5;
/// No proportion of counts needs a larger d'.
constexpr double kMaxDPrime = 50.0;

void require_alternatives(int alternatives) {
  if (alternatives < 2) throw std::invalid_argument("d' needs at least two alternatives");
}

/// \param share  in (0, 1)
double d_prime_of(double share, int alternatives) {
  const auto excess = [&](double d) { return proportion_correct_of(d, alternatives) - share; };
  std::uintmax_t most_steps = 200;
  const std::pair<double, double> bracket = boost::math::tools::toms748_solve(
      excess, -kMaxDPrime, kMaxDPrime, boost::math::tools::eps_tolerance<double>(44), most_steps);
  return std::midpoint(bracket.first, bracket.second);
}

}  // namespace

double proportion_correct_of(double d_prime, int alternatives) {
  require_alternatives(alternatives);
  if (!std::isfinite(d_prime)) throw std::invalid_argument("d' must be finite");
  const boost::math::normal_distribution<> normal;
  // The integral over z with z = u + d', so that the weight does not depend on d'.
  const auto density_of_correct = [&](double u) {
    const double others_weaker =
        u + d_prime < kCertain ? boost::math::cdf(normal, u + d_prime) : 1.0;
    return boost::math::pdf(normal, u) * std::pow(others_weaker, alternatives - 1);
  };
  // The integrand vanishes at both ends, so the trapezoidal rule converges exponentially.
  const double share = boost::math::quadrature::trapezoidal(density_of_correct, -kIntegrationLimit,
                                                            kIntegrationLimit, 1e-13);
  return std::clamp(share, 0.0, 1.0);
}

DPrime d_prime(Proportion proportion, int alternatives, const Interval& limits) {
  require_alternatives(alternatives);
  require_possible(proportion);
  if (!(limits.low >= 0.0 && limits.low <= limits.high && limits.high <= 1.0)) {
    throw std::invalid_argument("the limits of a share must be in [0, 1]");
  }
  DPrime result;
  if (limits.low > 0.0 && limits.low < 1.0) result.low = d_prime_of(limits.low, alternatives);
  if (limits.high > 0.0 && limits.high < 1.0) result.high = d_prime_of(limits.high, alternatives);
  if (proportion.correct > 0 && proportion.correct < proportion.n) {
    result.estimate = d_prime_of(*proportion.share(), alternatives);
  }
  return result;
}

DPrime d_prime(Proportion proportion, int alternatives, double level) {
  return d_prime(proportion, alternatives, clopper_pearson_interval(proportion, level));
}

}  // namespace touchtrial::analysis

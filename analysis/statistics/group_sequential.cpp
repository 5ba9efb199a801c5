#include "analysis/statistics/group_sequential.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/tools/roots.hpp>

namespace touchtrial::analysis {
namespace {

constexpr int kMinSteps = 800;           ///< steps of Simpson's rule
constexpr double kMinStepsPerSd = 16.0;  ///< steps per standard deviation of an increment
constexpr double kMaxSteps = 100'000;
constexpr double kMaxDistance_sd = 9.0;  ///< the density is negligible beyond this

double tail_above(double z) {
  return cdf(complement(boost::math::normal(), z));
}

double spent_one_sided(double alpha, AlphaSpending spending, double share) {
  if (spending == AlphaSpending::pocock) {
    return alpha * std::log1p((std::numbers::e - 1.0) * share);
  }
  const double z = quantile(complement(boost::math::normal(), alpha / 2.0));
  return 2.0 * tail_above(z / std::sqrt(share));
}

/// An even number of steps, small compared with the narrowest increment.
int steps_between(double low, double high, double min_sd) {
  const double steps_needed = std::min(kMaxSteps, (high - low) * kMinStepsPerSd / min_sd);
  const int steps = std::max(kMinSteps, static_cast<int>(steps_needed));
  return steps + steps % 2;
}

/// The density of the cumulative sum among studies that continued, on an even grid.
struct Paths {
  std::vector<double> place{0.0};
  std::vector<double> mass{1.0};  ///< density times the weight of Simpson's rule

  /// The probability that the sum after another increment is at least `bound`.
  [[nodiscard]] double crossing(double bound, double sd) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i)
      sum += mass[i] * tail_above((bound - place[i]) / sd);
    return sum;
  }

  /// The density of the sum after another increment.
  [[nodiscard]] double density(double sum_value, double sd) const {
    const double distance = kMaxDistance_sd * sd;
    auto i = static_cast<std::size_t>(std::ranges::lower_bound(place, sum_value - distance) -
                                      place.begin());
    double sum = 0.0;
    for (; i < place.size() && place[i] <= sum_value + distance; ++i) {
      const double z = (sum_value - place[i]) / sd;
      sum += mass[i] * std::exp(-0.5 * z * z);
    }
    return sum / (sd * std::sqrt(2.0 * std::numbers::pi));
  }

  /// Adds an increment and keeps the sums between low and high.
  /// \param next_sd  standard deviation of the following increment
  void advance(double sd, double next_sd, double low, double high) {
    const int steps = steps_between(low, high, std::min(sd, next_sd));
    const double step = (high - low) / steps;
    Paths next{std::vector<double>(steps + 1), std::vector<double>(steps + 1)};
    for (int k = 0; k <= steps; ++k) {
      const double sum_value = low + k * step;
      const double weight = k == 0 || k == steps ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
      next.place[k] = sum_value;
      next.mass[k] = density(sum_value, sd) * weight * step / 3.0;
    }
    *this = std::move(next);
  }
};

double bound_for(const Paths& paths, double sd, double probability) {
  std::uintmax_t steps = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(
      [&](double bound) { return paths.crossing(bound, sd) - probability; }, -kMaxDistance_sd, 40.0,
      boost::math::tools::eps_tolerance<double>(45), steps);
  return 0.5 * (a + b);
}

void require_shares(std::span<const double> shares) {
  double previous = 0.0;
  for (const double share : shares) {
    if (!(share > previous && share <= 1.0)) {
      throw std::invalid_argument("shares of the information must increase within (0, 1]");
    }
    previous = share;
  }
}

}  // namespace

std::vector<double> nominal_levels(double alpha, Sides sides, AlphaSpending spending,
                                   std::span<const double> shares) {
  if (!(alpha > 0.0 && alpha <= 0.5)) throw std::invalid_argument("alpha must be in (0, 0.5]");
  require_shares(shares);
  const double side_alpha = sides == Sides::one ? alpha : alpha / 2.0;
  std::vector<double> levels;
  Paths paths;
  double spent = 0.0;
  double sd = shares.empty() ? 0.0 : std::sqrt(shares.front());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double root = std::sqrt(shares[i]);
    const double spendable = spent_one_sided(side_alpha, spending, shares[i]);
    const double bound = bound_for(paths, sd, spendable - spent);
    levels.push_back((sides == Sides::one ? 1.0 : 2.0) * tail_above(bound / root));
    spent = spendable;
    if (i + 1 == shares.size()) break;
    const double next_sd = std::sqrt(shares[i + 1] - shares[i]);
    const double distance = kMaxDistance_sd * root;
    const double high = std::min(bound, distance);
    paths.advance(sd, next_sd, sides == Sides::one ? -distance : -high, high);
    sd = next_sd;
  }
  return levels;
}

}  // namespace touchtrial::analysis

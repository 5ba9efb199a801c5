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

constexpr int kGridSteps = 800;    ///< of Simpson's rule, even
constexpr double kFarthest = 9.0;  ///< standard deviations beyond which nothing is left

double above(double z) {
  return cdf(complement(boost::math::normal(), z));
}

double spent_one_sided(double alpha, AlphaSpending spending, double share) {
  if (spending == AlphaSpending::pocock) {
    return alpha * std::log1p((std::numbers::e - 1.0) * share);
  }
  const double z = quantile(complement(boost::math::normal(), alpha / 2.0));
  return 2.0 * above(z / std::sqrt(share));
}

/// The density of the sum so far among studies that went on, on an even grid.
struct Paths {
  std::vector<double> place{0.0};
  std::vector<double> mass{1.0};  ///< density times weight of the rule

  /// The probability that the sum after another increment is at least `bound`.
  [[nodiscard]] double crossing(double bound, double sd) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i) sum += mass[i] * above((bound - place[i]) / sd);
    return sum;
  }

  /// Goes on with the sums between low and high.
  void advance(double sd, double low, double high) {
    Paths next{std::vector<double>(kGridSteps + 1), std::vector<double>(kGridSteps + 1)};
    const double step = (high - low) / kGridSteps;
    const double scale = 1.0 / (sd * std::sqrt(2.0 * std::numbers::pi));
    for (int k = 0; k <= kGridSteps; ++k) {
      const double at = low + k * step;
      double density = 0.0;
      for (std::size_t i = 0; i < place.size(); ++i) {
        const double z = (at - place[i]) / sd;
        density += mass[i] * std::exp(-0.5 * z * z);
      }
      const double weight = k == 0 || k == kGridSteps ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
      next.place[k] = at;
      next.mass[k] = scale * density * weight * step / 3.0;
    }
    *this = std::move(next);
  }
};

/// The bound that this much of the probability crosses.
double bound_for(const Paths& paths, double sd, double wanted) {
  std::uintmax_t steps = 200;
  const auto [a, b] = boost::math::tools::toms748_solve(
      [&](double bound) { return paths.crossing(bound, sd) - wanted; }, -kFarthest, 40.0,
      boost::math::tools::eps_tolerance<double>(45), steps);
  return 0.5 * (a + b);
}

void require_shares(std::span<const double> shares) {
  double before = 0.0;
  for (const double share : shares) {
    if (!(share > before && share <= 1.0)) {
      throw std::invalid_argument("shares of the information ascend within (0, 1]");
    }
    before = share;
  }
}

}  // namespace

std::vector<double> nominal_levels(double alpha, Sides sides, AlphaSpending spending,
                                   std::span<const double> shares) {
  if (!(alpha > 0.0 && alpha <= 0.5)) throw std::invalid_argument("alpha lies in (0, 0.5]");
  require_shares(shares);
  const double of_side = sides == Sides::one ? alpha : alpha / 2.0;
  std::vector<double> levels;
  Paths paths;
  double share = 0.0;
  double spent = 0.0;
  for (const double next : shares) {
    const double sd = std::sqrt(next - share);
    const double allowed = spent_one_sided(of_side, spending, next);
    const double bound = bound_for(paths, sd, allowed - spent);
    const double z = bound / std::sqrt(next);
    levels.push_back((sides == Sides::one ? 1.0 : 2.0) * above(z));
    const double reach = kFarthest * std::sqrt(next);
    const double high = std::min(bound, reach);
    paths.advance(sd, sides == Sides::one ? -reach : -high, high);
    share = next;
    spent = allowed;
  }
  return levels;
}

}  // namespace touchtrial::analysis

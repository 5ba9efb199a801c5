#include "analysis/statistics/odds_ratio.hpp"

#include <cmath>
#include <stdexcept>

#include <boost/math/distributions/normal.hpp>

namespace touchtrial::analysis {
namespace {

void require_valid(const Proportion& one) {
  if (one.correct < 0 || one.correct > one.n) {
    throw std::invalid_argument("an odds ratio needs 0 <= correct <= n");
  }
}

/// The sums over strata that the estimate and its variance are made of, in the letters of Robins,
/// Breslow and Greenland.
struct Sums {
  double r = 0.0, s = 0.0, pr = 0.0, ps_qr = 0.0, qs = 0.0;

  void add(const Proportion& first, const Proportion& second) {
    const double n = static_cast<double>(first.n) + second.n;
    if (n == 0.0) return;
    const double first_wrong = first.n - first.correct;
    const double second_wrong = second.n - second.correct;
    const double p = (first.correct + second_wrong) / n;
    const double q = (first_wrong + second.correct) / n;
    const double here_r = first.correct * second_wrong / n;
    const double here_s = first_wrong * second.correct / n;
    r += here_r;
    s += here_s;
    pr += p * here_r;
    ps_qr += p * here_s + q * here_r;
    qs += q * here_s;
  }

  [[nodiscard]] double variance_of_log() const {
    return pr / (2.0 * r * r) + ps_qr / (2.0 * r * s) + qs / (2.0 * s * s);
  }
};

}  // namespace

std::optional<OddsRatio> mantel_haenszel(
    std::span<const std::pair<Proportion, Proportion>> participants, double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("a confidence level lies between 0 and 1");
  }
  Sums sums;
  for (const auto& [first, second] : participants) {
    require_valid(first);
    require_valid(second);
    sums.add(first, second);
  }
  if (sums.r == 0.0 || sums.s == 0.0) return std::nullopt;
  const double estimate = sums.r / sums.s;
  const double z = boost::math::quantile(boost::math::normal_distribution<>(), 0.5 + level / 2.0);
  const double factor = std::exp(z * std::sqrt(sums.variance_of_log()));
  return OddsRatio{estimate, {estimate / factor, estimate * factor}};
}

}  // namespace touchtrial::analysis

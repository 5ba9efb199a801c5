#include "analysis/statistics/prevalence.hpp"

#include "analysis/statistics/common.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/tools/roots.hpp>

namespace touchtrial::analysis {
namespace {

/// Beta(passed + 1, failed + 1), cut to [level, 1].
class CutPosterior {
 public:
  CutPosterior(Proportion tests, double level)
      : passed_(tests.correct),
        failed_(tests.n - tests.correct),
        beta_(passed_ + 1.0, failed_ + 1.0),
        above_(cdf(complement(beta_, level))) {}

  /// The quantile of the cut posterior.
  [[nodiscard]] double quantile(double share) const {
    // Computed from the upper tail, which stays accurate if most of the distribution is cut off.
    return boost::math::quantile(boost::math::complement(beta_, (1.0 - share) * above_));
  }

  [[nodiscard]] double log_density(double at) const {
    return weighed(passed_, at) + weighed(failed_, 1.0 - at);
  }

 private:
  static double weighed(double count, double of) {
    return count == 0.0 ? 0.0 : count * std::log(of);
  }

  double passed_;
  double failed_;
  boost::math::beta_distribution<> beta_;
  double above_;
};

/// The shortest interval with this share of the posterior.
Interval densest(const CutPosterior& posterior, double level, double share) {
  const double rest = 1.0 - share;
  // The posterior has one peak, so the difference of the ends' densities rises with the part that
  // is left out below.
  const auto steeper_below = [&](double below) {
    const double low = below == 0.0 ? level : posterior.quantile(below);
    const double high = below == rest ? 1.0 : posterior.quantile(below + share);
    return posterior.log_density(low) - posterior.log_density(high);
  };
  if (steeper_below(0.0) >= 0.0) return {level, posterior.quantile(share)};
  if (steeper_below(rest) <= 0.0) return {posterior.quantile(rest), 1.0};
  std::uintmax_t steps = 200;
  // A density may be 0 at an end, where only the sign of the difference is known.
  const auto [a, b] = boost::math::tools::bisect(
      steeper_below, 0.0, rest, boost::math::tools::eps_tolerance<double>(50), steps);
  const double below = 0.5 * (a + b);
  return {posterior.quantile(below), posterior.quantile(below + share)};
}

}  // namespace

std::optional<Prevalence> prevalence_of(Proportion tests, double level, double share) {
  require_possible(tests);
  require_level(share);
  if (!(level >= 0.0 && level < 1.0)) {
    throw std::invalid_argument("a test's level must be in [0, 1)");
  }
  if (tests.n == 0) return std::nullopt;
  const auto prevalence = [level](double passing) {
    return std::clamp((passing - level) / (1.0 - level), 0.0, 1.0);
  };
  const Interval passing = densest(CutPosterior(tests, level), level, share);
  return Prevalence{tests.n,
                    tests.correct,
                    level,
                    prevalence(*tests.share()),
                    {prevalence(passing.low), prevalence(passing.high)}};
}

}  // namespace touchtrial::analysis

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

/// Beta(passed + 1, failed + 1), truncated to [level, 1].
class TruncatedPosterior {
 public:
  TruncatedPosterior(Proportion tests, double level)
      : passed_(tests.correct),
        failed_(tests.n - tests.correct),
        beta_(passed_ + 1.0, failed_ + 1.0),
        upper_mass_(cdf(complement(beta_, level))) {}

  [[nodiscard]] double quantile(double share) const {
    // Computed from the upper tail, which stays accurate if most of the distribution is truncated.
    return boost::math::quantile(boost::math::complement(beta_, (1.0 - share) * upper_mass_));
  }

  [[nodiscard]] double log_density(double probability) const {
    return log_power(passed_, probability) + log_power(failed_, 1.0 - probability);
  }

 private:
  /// count * log(probability); 0 for a count of 0, even if the probability is 0.
  static double log_power(double count, double probability) {
    return count == 0.0 ? 0.0 : count * std::log(probability);
  }

  double passed_;
  double failed_;
  boost::math::beta_distribution<> beta_;
  double upper_mass_;
};

/// The shortest interval that contains this share of the posterior.
Interval highest_density_interval(const TruncatedPosterior& posterior, double level, double share) {
  const double omitted_share = 1.0 - share;
  // The posterior has one peak, so the difference of the densities at the ends increases with the
  // share omitted below.
  const auto density_difference = [&](double lower_tail) {
    const double low = lower_tail == 0.0 ? level : posterior.quantile(lower_tail);
    const double high = lower_tail == omitted_share ? 1.0 : posterior.quantile(lower_tail + share);
    return posterior.log_density(low) - posterior.log_density(high);
  };
  if (density_difference(0.0) >= 0.0) return {level, posterior.quantile(share)};
  if (density_difference(omitted_share) <= 0.0) return {posterior.quantile(omitted_share), 1.0};
  std::uintmax_t steps = 200;
  // A density may be 0 at an end, where only the sign of the difference is known.
  const auto [a, b] = boost::math::tools::bisect(
      density_difference, 0.0, omitted_share, boost::math::tools::eps_tolerance<double>(50), steps);
  const double lower_tail = 0.5 * (a + b);
  return {posterior.quantile(lower_tail), posterior.quantile(lower_tail + share)};
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
  const Interval passing = highest_density_interval(TruncatedPosterior(tests, level), level, share);
  return Prevalence{tests.n,
                    tests.correct,
                    level,
                    prevalence(*tests.share()),
                    {prevalence(passing.low), prevalence(passing.high)}};
}

}  // namespace touchtrial::analysis

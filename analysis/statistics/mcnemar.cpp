#include "analysis/statistics/mcnemar.hpp"

#include <algorithm>
#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>

namespace touchtrial::analysis {

double mcnemar_mid_p(int first_only, int second_only) {
  if (first_only < 0 || second_only < 0) {
    throw std::invalid_argument("McNemar's test needs counts of 0 or more");
  }
  const int pairs = first_only + second_only;
  if (pairs == 0) return 1.0;
  const boost::math::binomial_distribution<> half(pairs, 0.5);
  const int fewer = std::min(first_only, second_only);
  const double as_extreme = boost::math::pdf(half, fewer);
  if (first_only == second_only) return 1.0 - 0.5 * as_extreme;  // this outcome is counted once
  return 2.0 * boost::math::cdf(half, fewer) - as_extreme;
}

}  // namespace touchtrial::analysis

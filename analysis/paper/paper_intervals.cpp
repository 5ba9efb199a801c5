#include "analysis/paper/paper_intervals.hpp"

#include "analysis/statistics/paired_tests.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/math/distributions/students_t.hpp>

namespace touchtrial::analysis {
namespace {

/// Rounding tolerance for a spread equal to largest_spread.
constexpr double kSpreadRounding = 1e-12;

void require_assumptions(bool in_range) {
  if (!in_range) {
    throw std::invalid_argument(
        "an assumed interval needs two people, a trial, and possible shares");
  }
}

/// The half-width of a t interval over people whose shares have this variance.
double half_width(double variance, int people) {
  const boost::math::students_t t(people - 1.0);
  return boost::math::quantile(t, 0.5 + 0.5 * kConfidenceLevel) * std::sqrt(variance / people);
}

double variance_of_share(double mean, double spread_variance, int trials) {
  return spread_variance + (mean * (1.0 - mean) - spread_variance) / trials;
}

bool is_possible(AssumedStudy study) {
  return study.people >= 2 && study.trials >= 1;
}

}  // namespace

double largest_spread(double mean) {
  return std::sqrt(mean * (1.0 - mean));
}

Interval assumed_interval(double mean, double spread, AssumedStudy study) {
  require_assumptions(is_possible(study) && mean >= 0.0 && mean <= 1.0 && spread >= 0.0 &&
                      spread <= largest_spread(mean) + kSpreadRounding);
  const double margin =
      half_width(variance_of_share(mean, spread * spread, study.trials), study.people);
  return {std::max(0.0, mean - margin), std::min(1.0, mean + margin)};
}

AssumedDifference assumed_difference(double first, double second, double spread,
                                     AssumedStudy study) {
  require_assumptions(is_possible(study) && first > 0.0 && first < 1.0 && second > 0.0 &&
                      second < 1.0 && spread >= 0.0);
  const double method_variance = 0.5 * spread * spread;
  const double v1 = variance_of_share(first, method_variance, study.trials);
  const double v2 = variance_of_share(second, method_variance, study.trials);
  const double margin = half_width(v1 + v2, study.people);
  const double margin_db = 10.0 / std::log(10.0) *
                           half_width(v1 / (first * first) + v2 / (second * second), study.people);
  const double difference = first - second;
  const double decibel = decibels(first, second).value();
  return {{difference - margin, difference + margin}, {decibel - margin_db, decibel + margin_db}};
}

}  // namespace touchtrial::analysis

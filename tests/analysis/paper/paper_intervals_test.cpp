#include "analysis/paper/paper_intervals.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

constexpr double kT19 = 2.0930240544082634;  ///< 97.5 % quantile of t with 19 degrees of freedom

/// A person's share of right answers.
double drawn_share(RandomStream& random, double probability, int trials) {
  int right = 0;
  for (int i = 0; i < trials; ++i) right += random.uniform() < probability ? 1 : 0;
  return right / static_cast<double>(trials);
}

/// One of two equally likely numbers around 0 with this standard deviation.
double drawn_offset(RandomStream& random, double deviation) {
  return random.uniform() < 0.5 ? -deviation : deviation;
}

}  // namespace

TEST_CASE("assumed intervals have the widths of their extremes") {
  const AssumedStudy study{20, 5};
  const double p = 0.72;
  const Interval alike = assumed_interval(p, 0.0, study);
  CHECK(alike.high - p == Approx(kT19 * std::sqrt(p * (1.0 - p) / 5.0 / 20.0)));
  CHECK(p - alike.low == Approx(alike.high - p));
  const Interval widest = assumed_interval(p, largest_spread(p), study);
  CHECK(widest.high - p == Approx(kT19 * std::sqrt(p * (1.0 - p) / 20.0)));
  CHECK(assumed_interval(0.99, 0.05, study).high == 1.0);
  CHECK(assumed_interval(1.0, 0.0, study) == Interval{1.0, 1.0});
}

TEST_CASE("t intervals of simulated people are on average as wide as assumed") {
  constexpr double kMean = 0.8;
  constexpr double kSpread = 0.15;
  constexpr int kStudies = 4000;
  RandomStream random(11, "assumed intervals");
  double squares = 0.0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> shares;
    for (int person = 0; person < 20; ++person) {
      shares.push_back(drawn_share(random, kMean + drawn_offset(random, kSpread), 5));
    }
    const MeanEstimate estimate = participant_mean(shares, {-10.0, 10.0});
    squares += std::pow(estimate.interval.high - *estimate.mean, 2);
  }
  const Interval assumed = assumed_interval(kMean, kSpread, {20, 5});
  CHECK(std::sqrt(squares / kStudies) == Approx(assumed.high - kMean).epsilon(0.02));
}

TEST_CASE("differences in points and decibels scatter as assumed") {
  constexpr double kFirst = 0.8;
  constexpr double kSecond = 0.7;
  constexpr double kSpread = 0.12;
  constexpr int kStudies = 8000;
  RandomStream random(12, "assumed differences");
  const double of_each = kSpread / std::sqrt(2.0);
  double points = 0.0;
  double decibel = 0.0;
  for (int study = 0; study < kStudies; ++study) {
    double first = 0.0;
    double second = 0.0;
    for (int person = 0; person < 20; ++person) {
      first += drawn_share(random, kFirst + drawn_offset(random, of_each), 20) / 20.0;
      second += drawn_share(random, kSecond + drawn_offset(random, of_each), 20) / 20.0;
    }
    points += std::pow(first - second - (kFirst - kSecond), 2);
    decibel += std::pow(*decibels(first, second) - *decibels(kFirst, kSecond), 2);
  }
  const AssumedDifference assumed = assumed_difference(kFirst, kSecond, kSpread, {20, 20});
  CHECK(kT19 * std::sqrt(points / kStudies) ==
        Approx(assumed.difference.high - (kFirst - kSecond)).epsilon(0.04));
  CHECK(kT19 * std::sqrt(decibel / kStudies) ==
        Approx(assumed.decibel.high - *decibels(kFirst, kSecond)).epsilon(0.04));
}

TEST_CASE("impossible assumptions are refused") {
  CHECK_THROWS_AS(assumed_interval(0.8, 0.41, {20, 5}), std::invalid_argument);
  CHECK_THROWS_AS(assumed_interval(0.8, -0.1, {20, 5}), std::invalid_argument);
  CHECK_THROWS_AS(assumed_interval(1.1, 0.0, {20, 5}), std::invalid_argument);
  CHECK_THROWS_AS(assumed_interval(std::nan(""), 0.0, {20, 5}), std::invalid_argument);
  CHECK_THROWS_AS(assumed_interval(0.8, 0.1, {1, 5}), std::invalid_argument);
  CHECK_THROWS_AS(assumed_interval(0.8, 0.1, {20, 0}), std::invalid_argument);
  CHECK_THROWS_AS(assumed_difference(0.8, 0.0, 0.1, {20, 5}), std::invalid_argument);
}

// References: SciPy 1.10 (stats.ttest_1samp, stats.beta, stats.chi2, stats.multivariate_normal).
#include "analysis/statistics/mean_test.hpp"

#include "analysis/statistics/group_sequential.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

const std::vector<double> kShares = {.28, .32, .2, .24, .36, .16, .44, .28};

}  // namespace

TEST_CASE("the t test of a mean has SciPy's p") {
  CHECK(*t_test_p(kShares, 0.2, Sides::one) == Approx(0.015481137992672474).epsilon(1e-9));
  CHECK(*t_test_p(kShares, 0.2, Sides::two) == Approx(0.03096227598534495).epsilon(1e-9));
  CHECK(*t_test_p(kShares, 0.5, Sides::one) > 0.5);
}

TEST_CASE("t and the effect size with its interval are SciPy's, by stats.nct") {
  const TStatistic found = t_statistic(kShares, 0.2).value();
  CHECK(found.t == Approx(2.6927487920984525).epsilon(1e-12));
  CHECK(found.degrees_of_freedom == 7);
  CHECK(found.d == Approx(0.9520304654623503).epsilon(1e-12));
  CHECK(found.interval->low == Approx(0.0821891084103069).epsilon(1e-8));
  CHECK(found.interval->high == Approx(1.7782941156843195).epsilon(1e-8));
  CHECK_FALSE(t_statistic_without_interval(kShares, 0.2)->interval);
  CHECK_FALSE(t_statistic(std::vector{0.5}));
  CHECK_FALSE(t_statistic(std::vector{0.5, 0.5, 0.5}));
  CHECK_FALSE(t_statistic(std::vector{0.5, 0.5 + 1e-6})->interval);
  CHECK_THROWS_AS(t_statistic(kShares, 0.2, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(t_statistic(std::vector{0.5, std::nan("")}), std::invalid_argument);
}

TEST_CASE("two perfect participants among 18 who guess do not raise the mean beyond chance") {
  std::vector<double> shares(18, 0.2);
  shares.insert(shares.end(), 2, 1.0);
  CHECK(*t_test_p(shares, 0.2, Sides::one) == Approx(0.08127499951486336).epsilon(1e-9));
}

TEST_CASE("participants who are all alike have the p of sign flips") {
  const std::vector<double> perfect(5, 1.0);
  CHECK(t_test_p(perfect, 0.2, Sides::one) == 1.0 / 32.0);
  CHECK(t_test_p(perfect, 0.2, Sides::two) == 2.0 / 32.0);
  CHECK(t_test_p(perfect, 1.0, Sides::two) == 1.0);
  const std::vector<double> hopeless(5, 0.0);
  CHECK(t_test_p(hopeless, 0.2, Sides::one) == 1.0);
  CHECK(t_test_p(hopeless, 0.2, Sides::two) == 2.0 / 32.0);
}

TEST_CASE("a t test needs two finite values") {
  CHECK_FALSE(t_test_p(std::vector<double>{}, 0.2, Sides::one));
  CHECK_FALSE(t_test_p(std::vector{0.5}, 0.2, Sides::one));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(t_test_p(std::vector{0.5, nan}, 0.2, Sides::one), std::invalid_argument);
  CHECK_THROWS_AS(t_test_p(kShares, nan, Sides::one), std::invalid_argument);
}

TEST_CASE("one-sided sign flips count the patterns with at least the observed sum") {
  const std::vector<double> differences = {0.2, 0.1, 0.04, -0.04};
  // Of 16 patterns, 3 have a sum of 0.3 or more: 0.38, and two of 0.3.
  CHECK(*sign_flip_p(differences, Sides::one) == Approx(3.0 / 16.0));
  CHECK(*sign_flip_p(differences) == Approx(6.0 / 16.0));
  const std::vector<double> opposite = {-0.2, -0.1, -0.04, 0.04};
  CHECK(*sign_flip_p(opposite, Sides::one) == Approx(15.0 / 16.0));
  std::vector<double> many(40, 0.04);
  for (std::size_t i = 0; i < 12; ++i) many[i] = -0.04;
  CHECK(*sign_flip_p(many, Sides::one) == Approx(0.5 * *sign_flip_p(many)).epsilon(0.1));
}

TEST_CASE("levels at looks are Lan and DeMets's") {
  using enum AlphaSpending;
  const std::vector<double> halves = {0.5, 1.0};
  const auto strict = nominal_levels(0.025, Sides::one, obrien_fleming, halves);
  // The published bounds are 2.963 and 1.969 (Jennison and Turnbull 2000, table 7.6).
  CHECK(strict[0] == Approx(0.0015253227579888758).epsilon(1e-5));
  CHECK(strict[1] == Approx(0.024499771789662596).epsilon(1e-5));
  const auto usual = nominal_levels(0.05, Sides::one, obrien_fleming, halves);
  CHECK(usual[0] == Approx(0.005574596680832595).epsilon(1e-5));
  CHECK(usual[1] == Approx(0.04824570306387283).epsilon(1e-5));
  const auto even = nominal_levels(0.05, Sides::one, pocock, std::vector{0.3, 0.6, 1.0});
  CHECK(even[0] == Approx(0.02078676109217236).epsilon(1e-5));
  CHECK(even[1] == Approx(0.021502412822525456).epsilon(1e-4));
  CHECK(even[2] == Approx(0.025324512873467108).epsilon(1e-4));
}

TEST_CASE("a two-sided test at looks is two one-sided ones at half the level") {
  const std::vector<double> shares = {0.25, 0.5, 1.0};
  const auto two = nominal_levels(0.05, Sides::two, AlphaSpending::obrien_fleming, shares);
  const auto one = nominal_levels(0.025, Sides::one, AlphaSpending::obrien_fleming, shares);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    CHECK(two[i] == Approx(2.0 * one[i]).epsilon(1e-4).margin(1e-9));
  }
}

TEST_CASE("levels hold for looks far too early, one participant apart, and at tiny alphas") {
  using enum AlphaSpending;
  // References: the crossing probabilities by Gauss-Legendre quadrature over the first look.
  const auto last = [](double alpha, AlphaSpending spending, std::vector<double> shares) {
    return nominal_levels(alpha, Sides::one, spending, shares).back();
  };
  CHECK(last(0.05, obrien_fleming, {0.9999, 1.0}) == Approx(0.0480676148895).epsilon(1e-5));
  CHECK(last(0.05, obrien_fleming, {0.99999, 1.0}) == Approx(0.0492493030083).epsilon(1e-5));
  CHECK(last(0.05, pocock, {0.99999, 1.0}) == Approx(0.0491171637433).epsilon(1e-5));
  CHECK(last(0.05, pocock, {0.00002, 1.0}) == Approx(0.0499983715606).epsilon(1e-5));
  CHECK(last(1e-6, pocock, {0.5, 1.0}) == Approx(3.9756109732778823e-07).epsilon(1e-4));
  const auto early =
      nominal_levels(0.05, Sides::one, obrien_fleming, std::vector{0.00002, 0.05, 1.0});
  CHECK(early[0] == 0.0);
  CHECK(early[1] == Approx(1.8640333261e-18).epsilon(1e-4));
  CHECK(early[2] == Approx(0.05).epsilon(1e-7));
}

TEST_CASE("twenty looks in a row have levels that ascend under O'Brien and Fleming's spending") {
  for (const double planned : {21.0, 100'000.0}) {
    std::vector<double> shares;
    for (int look = 1; look <= 20; ++look) shares.push_back((planned - 21.0 + look) / planned);
    shares.push_back(1.0);
    const auto levels = nominal_levels(0.05, Sides::two, AlphaSpending::obrien_fleming, shares);
    CHECK(levels.back() < 0.05);
    CHECK(levels.back() > 0.025);
    if (planned < 100.0) CHECK(std::ranges::is_sorted(levels));
  }
}

TEST_CASE("without a look before the end the level is alpha") {
  const auto levels =
      nominal_levels(0.05, Sides::one, AlphaSpending::obrien_fleming, std::vector{1.0});
  CHECK(levels.at(0) == Approx(0.05).epsilon(1e-9));
  CHECK(nominal_levels(0.05, Sides::one, AlphaSpending::pocock, {}).empty());
  CHECK_THROWS_AS(nominal_levels(0.05, Sides::one, AlphaSpending::pocock, std::vector{0.5, 0.5}),
                  std::invalid_argument);
  CHECK_THROWS_AS(nominal_levels(0.0, Sides::one, AlphaSpending::pocock, std::vector{1.0}),
                  std::invalid_argument);
}

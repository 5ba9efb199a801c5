// References: SciPy 1.10 (stats.chi2, stats.beta, optimize.brentq).
#include "analysis/statistics/spread.hpp"

#include "analysis/statistics/prevalence.hpp"
#include "support/catch.hpp"

#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

TEST_CASE("the spread between participants is without the chance of limited trials") {
  const std::vector<Proportion> even = {{25, 20}, {25, 15}, {25, 22}, {25, 12},
                                        {25, 18}, {25, 24}, {25, 9},  {25, 17}};
  const Spread found = *spread_of(even);
  CHECK(found.estimate == Approx(0.18199579730888085).epsilon(1e-7));
  CHECK(found.interval.low == Approx(0.09705239532725013).epsilon(1e-7));
  CHECK(found.interval.high == Approx(0.4067626056877112).epsilon(1e-7));
}

TEST_CASE("participants with unequal numbers of trials have their own variances") {
  const std::vector<Proportion> uneven = {{25, 20}, {20, 15}, {25, 22}, {25, 12}, {10, 5}, {12, 9}};
  const Spread found = *spread_of(uneven);
  CHECK(found.estimate == Approx(0.1286252655980292).epsilon(1e-6));
  CHECK(found.interval.low == Approx(0.0063755305510513486).epsilon(1e-4));
  CHECK(found.interval.high == Approx(0.40003142470612524).epsilon(1e-6));
  std::vector<Proportion> more = uneven;
  more.push_back({1, 1});
  CHECK(spread_of(more)->estimate == found.estimate);
}

TEST_CASE("participants who are more alike than chance makes them have no spread") {
  const std::vector<Proportion> alike(4, {25, 5});
  CHECK(spread_of(alike)->estimate == 0.0);
  CHECK(spread_of(alike)->interval == Interval{0.0, 0.0});
}

TEST_CASE("a spread needs two participants and answers that differ") {
  CHECK_FALSE(spread_of(std::vector<Proportion>{}));
  CHECK_FALSE(spread_of(std::vector<Proportion>{{25, 20}}));
  CHECK_FALSE(spread_of(std::vector<Proportion>(3, {25, 25})));
  CHECK_FALSE(spread_of(std::vector<Proportion>(3, {1, 1})));
  CHECK_THROWS_AS(spread_of(std::vector<Proportion>(3, {0, 0})), std::invalid_argument);
  CHECK_THROWS_AS(spread_of(std::vector<Proportion>(3, {4, 5})), std::invalid_argument);
}

TEST_CASE("the prevalence is the mode of its posterior, with its densest part") {
  const Prevalence most = *prevalence_of({20, 15}, 0.04);
  CHECK(most.estimate == Approx(0.7395833333333334));
  CHECK(most.interval.low == Approx(0.5252874713275443).epsilon(1e-7));
  CHECK(most.interval.high == Approx(0.8945871047946878).epsilon(1e-7));
  const Prevalence few = *prevalence_of({20, 3}, 0.0504);
  CHECK(few.estimate == Approx(0.10488626790227464));
  CHECK(few.interval.low == 0.0);
  CHECK(few.interval.high == Approx(0.2946778959001637).epsilon(1e-7));
}

TEST_CASE("a prevalence is 0 if no more pass than by chance, and 1 if all pass") {
  const Prevalence none = *prevalence_of({20, 0}, 0.05);
  CHECK(none.estimate == 0.0);
  CHECK(none.interval.low == 0.0);
  CHECK(none.interval.high == Approx(0.1329459110265234).epsilon(1e-7));
  CHECK(prevalence_of({20, 1}, 0.05)->estimate == 0.0);
  const Prevalence all = *prevalence_of({20, 20}, 0.05);
  CHECK(all.estimate == 1.0);
  CHECK(all.interval.low == Approx(0.8600569357615544).epsilon(1e-7));
  CHECK(all.interval.high == 1.0);
}

TEST_CASE("a prevalence needs participants and a level below 1") {
  CHECK_FALSE(prevalence_of({0, 0}, 0.05));
  CHECK_THROWS_AS(prevalence_of({20, 5}, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(prevalence_of({20, 21}, 0.05), std::invalid_argument);
}

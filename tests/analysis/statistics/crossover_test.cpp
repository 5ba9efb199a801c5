// References: SciPy 1.10 (stats.ttest_ind of period differences); all 64 deals listed one by one.
#include "analysis/statistics/crossover.hpp"

#include "support/catch.hpp"

#include <limits>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

/// Five blocks of two, and one person whose partner is missing.
std::vector<CrossoverPerson> eleven_people() {
  const std::vector<double> first_first = {.12, .2, -.04, .08, .16, .0};
  const std::vector<double> second_first = {-.08, .04, -.12, .0, .08};
  std::vector<CrossoverPerson> people;
  for (int i = 0; i < 6; ++i) people.push_back({first_first[i], true, i});
  for (int i = 0; i < 5; ++i) people.push_back({second_first[i], false, i});
  return people;
}

}  // namespace

TEST_CASE("the period-adjusted comparison has SciPy's p and interval") {
  const CrossoverEstimate found = crossover_estimate(eleven_people(), 0.0, Sides::two);
  CHECK(found.first_first == 6);
  CHECK(found.second_first == 5);
  CHECK(*found.effect == Approx(0.035333333333333335));
  CHECK(*found.period == Approx(-0.051333333333333335));
  CHECK(*found.p == Approx(0.2197366143044708).epsilon(1e-9));
  CHECK(found.interval->low == Approx(-0.025264627731470528).epsilon(1e-9));
  CHECK(found.interval->high == Approx(0.09593129439813719).epsilon(1e-9));
  CHECK(found.period_interval->low == Approx(-0.1119312943981372).epsilon(1e-9));
  CHECK(found.period_interval->high == Approx(0.009264627731470527).epsilon(1e-9));
}

TEST_CASE("a margin is the same test about minus the margin") {
  const CrossoverEstimate found = crossover_estimate(eleven_people(), -0.07, Sides::one, 0.9);
  CHECK(*found.p == Approx(0.0017233756180782195).epsilon(1e-9));
  CHECK(found.interval->low == Approx(-0.013771524609311692).epsilon(1e-9));
  CHECK(found.interval->high == Approx(0.08443819127597836).epsilon(1e-9));
}

TEST_CASE("orders are dealt anew block by block, and a person without a partner gets either") {
  CHECK(crossover_permutation(eleven_people(), 0.0, Sides::two)->p == 0.34375);
  CHECK(crossover_permutation(eleven_people(), 0.0, Sides::one)->p == 0.171875);
  CHECK(crossover_permutation(eleven_people(), -0.07, Sides::two)->p == 0.09375);
  CHECK(crossover_permutation(eleven_people(), -0.07, Sides::one)->p == 0.046875);
  CHECK(crossover_permutation(eleven_people(), 0.0, Sides::two)->least == 2.0 / 64.0);
  CHECK(crossover_permutation(eleven_people(), 0.0, Sides::one)->least == 1.0 / 64.0);
}

TEST_CASE("a period that is the same for everybody changes neither effect nor p") {
  std::vector<CrossoverPerson> learning = eleven_people();
  for (CrossoverPerson& one : learning) one.difference += one.first_method_first ? -0.17 : 0.17;
  const CrossoverEstimate before = crossover_estimate(eleven_people(), 0.0, Sides::two);
  const CrossoverEstimate after = crossover_estimate(learning, 0.0, Sides::two);
  CHECK(*after.effect == Approx(*before.effect));
  CHECK(*after.p == Approx(*before.p));
  CHECK(*after.period == Approx(*before.period + 0.17));
  CHECK(crossover_permutation(learning, 0.0, Sides::two)->p ==
        crossover_permutation(eleven_people(), 0.0, Sides::two)->p);
}

TEST_CASE("with one order of methods there is no effect, and with two people no interval") {
  const std::vector<CrossoverPerson> one_order = {{0.1, true, 0}, {0.2, true, 1}, {0.3, true, 2}};
  const CrossoverEstimate none = crossover_estimate(one_order, 0.0, Sides::two);
  CHECK(none.first_first == 3);
  CHECK_FALSE(none.effect);
  CHECK_FALSE(none.p);
  CHECK_FALSE(crossover_permutation(one_order, 0.0, Sides::two));
  const std::vector<CrossoverPerson> pair = {{0.1, true, 0}, {0.2, false, 0}};
  const CrossoverEstimate two = crossover_estimate(pair, 0.0, Sides::two);
  CHECK(*two.effect == Approx(0.15));
  CHECK_FALSE(two.interval);
  CHECK_FALSE(two.p);
}

TEST_CASE("people who are alike within their order have the p of the deals") {
  std::vector<CrossoverPerson> alike;
  for (int i = 0; i < 8; ++i) alike.push_back({i % 2 == 0 ? 0.3 : 0.1, i % 2 == 0, i / 2});
  const CrossoverEstimate found = crossover_estimate(alike, 0.0, Sides::two);
  CHECK(*found.p == 2.0 / 16.0);
  CHECK(*found.effect == Approx(0.2));
  CHECK_FALSE(found.interval);
  CHECK_FALSE(found.period_interval);
  for (CrossoverPerson& one : alike) one.difference = one.first_method_first ? 0.1 : -0.1;
  CHECK(crossover_estimate(alike, 0.0, Sides::two).p == 1.0);
  CHECK(crossover_permutation(alike, 0.0, Sides::two)->least == 1.0);
}

TEST_CASE("people without a block, or with the same order in one, are dealt one by one") {
  std::vector<CrossoverPerson> people = eleven_people();
  for (CrossoverPerson& one : people) one.block = -1;
  CHECK(crossover_permutation(people, 0.0, Sides::one)->least == 1.0 / 2048.0);
  const std::vector<CrossoverPerson> strange = {
      {0.1, true, 0}, {0.2, true, 0}, {0.4, false, 1}, {0.2, false, 1}};
  CHECK(crossover_permutation(strange, 0.0, Sides::one)->least == 1.0 / 16.0);
}

TEST_CASE("a crossover refuses what is no number") {
  const std::vector<CrossoverPerson> bad = {{std::numeric_limits<double>::quiet_NaN(), true, 0}};
  CHECK_THROWS_AS(crossover_estimate(bad, 0.0, Sides::two), std::invalid_argument);
  CHECK_THROWS_AS(crossover_permutation(bad, 0.0, Sides::two), std::invalid_argument);
  CHECK_THROWS_AS(crossover_estimate({}, 0.0, Sides::two, 1.0), std::invalid_argument);
}

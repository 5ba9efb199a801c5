// References: statsmodels 0.13 (stats.meta_analysis.combine_effects, method "iterated", with HKSJ's
// variance and t), SciPy 1.10.
#include "analysis/statistics/strata.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "support/catch.hpp"

#include <limits>
#include <stdexcept>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

using Strata = std::vector<std::vector<double>>;

const Strata kSix = {{0.5, 0.6, 0.55}, {0.7, 0.8},  {0.4, 0.45, 0.5, 0.35},
                     {0.9, 0.7, 0.8},  {0.6, 0.62}, {0.3, 0.5, 0.4}};

}  // namespace

TEST_CASE("fixed strata take the spread within them, random ones that between them") {
  const StratifiedMean found = *stratified_mean(kSix);
  CHECK(found.strata == 6);
  CHECK(found.mean == Approx(0.5688235294117647));
  CHECK(found.interval->low == Approx(0.5285212062069722));
  CHECK(found.interval->high == Approx(0.6091258526165573));
  REQUIRE(found.random.has_value());
  CHECK(found.random->mean == Approx(0.5876302164880962));
  CHECK(found.random->interval.low == Approx(0.41472458921524935));
  CHECK(found.random->interval.high == Approx(0.7605358437609431));
  CHECK(found.random->spread == Approx(0.15817352763924727));
}

TEST_CASE("strata are random from six on, and empty ones do not count") {
  Strata five = kSix;
  five[2].clear();
  const StratifiedMean found = *stratified_mean(five);
  CHECK(found.strata == 5);
  CHECK_FALSE(found.random.has_value());
  CHECK_FALSE(stratified_mean(Strata{{0.5, 0.6}, {}}));
}

TEST_CASE("strata of one participant each leave nothing to estimate an interval from") {
  const StratifiedMean found = *stratified_mean(Strata(7, {0.5}));
  CHECK(found.mean == 0.5);
  CHECK_FALSE(found.interval.has_value());
  CHECK_FALSE(found.random.has_value());
}

TEST_CASE("strata without any spread within them have no interval") {
  const StratifiedMean found = *stratified_mean(Strata{{0.4, 0.4}, {0.6, 0.6, 0.6}});
  CHECK(found.mean == Approx(0.52));
  CHECK_FALSE(found.interval.has_value());
}

TEST_CASE("equal strata have the interval of participants, but for one degree each") {
  const StratifiedMean found = *stratified_mean(Strata{{0.4, 0.6}, {0.4, 0.6}}, {0.0, 1.0}, 0.9);
  const std::vector<double> all = {0.4, 0.6, 0.4, 0.6};
  CHECK(found.mean == Approx(*participant_mean(all).mean));
  CHECK(found.interval->high == Approx(0.5 + 2.919985580 * 0.1414213562 / 2.0));  // 2 degrees
}

TEST_CASE("strata need finite values and a level between 0 and 1") {
  CHECK_THROWS_AS(stratified_mean(kSix, {0.0, 1.0}, 1.0), std::invalid_argument);
  const Strata broken = {{0.5}, {std::numeric_limits<double>::quiet_NaN()}};
  CHECK_THROWS_AS(stratified_mean(broken), std::invalid_argument);
}

#include "analysis/statistics/odds_ratio.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using Pairs = std::vector<std::pair<analysis::Proportion, analysis::Proportion>>;

}  // namespace

// Expected values: statsmodels 0.13, StratifiedTable.oddsratio_pooled and its confint.
TEST_CASE("mantel_haenszel gives the values of an independent implementation") {
  const Pairs participants{
      {{25, 20}, {25, 15}}, {{25, 22}, {25, 19}}, {{20, 9}, {24, 12}}, {{25, 25}, {25, 21}}};
  const analysis::OddsRatio ratio = *analysis::mantel_haenszel(participants);
  CHECK(ratio.estimate == Approx(1.9671179883945844).epsilon(1e-12));
  CHECK(ratio.interval.low == Approx(0.9704599695933296).epsilon(1e-12));
  CHECK(ratio.interval.high == Approx(3.9873393045640917).epsilon(1e-12));
}

TEST_CASE("mantel_haenszel equals the sums done by hand") {
  // (20*10/50 + 4*3/10) / (5*15/50 + 1*2/10)
  const Pairs participants{{{25, 20}, {25, 15}}, {{5, 4}, {5, 2}}};
  CHECK(analysis::mantel_haenszel(participants)->estimate == Approx((4.0 + 1.2) / (1.5 + 0.2)));
}

TEST_CASE("Of one participant mantel_haenszel is the odds ratio with Woolf's interval") {
  const Pairs one{{{25, 20}, {25, 15}}};
  const analysis::OddsRatio ratio = *analysis::mantel_haenszel(one);
  const double error = std::sqrt(1.0 / 20 + 1.0 / 5 + 1.0 / 15 + 1.0 / 10);
  CHECK(ratio.estimate == Approx(20.0 * 10.0 / (5.0 * 15.0)));
  CHECK(std::log(ratio.interval.high / ratio.estimate) == Approx(1.959963984540054 * error));
}

TEST_CASE("Exchanging the methods turns mantel_haenszel upside down") {
  const Pairs there{{{25, 20}, {25, 15}}, {{20, 9}, {24, 12}}};
  const Pairs back{{{25, 15}, {25, 20}}, {{24, 12}, {20, 9}}};
  CHECK(analysis::mantel_haenszel(there)->estimate ==
        Approx(1.0 / analysis::mantel_haenszel(back)->estimate));
  CHECK(analysis::mantel_haenszel(there)->interval.low ==
        Approx(1.0 / analysis::mantel_haenszel(back)->interval.high));
}

TEST_CASE("Participants with nothing wrong, or without trials, change no odds ratio") {
  Pairs participants{{{25, 20}, {25, 15}}};
  const analysis::OddsRatio before = *analysis::mantel_haenszel(participants);
  participants.push_back({{25, 25}, {25, 25}});
  participants.push_back({{0, 0}, {0, 0}});
  participants.push_back({{25, 3}, {0, 0}});
  CHECK(analysis::mantel_haenszel(participants)->estimate == Approx(before.estimate));
}

TEST_CASE("An odds ratio that is 0 or infinite is none") {
  CHECK_FALSE(analysis::mantel_haenszel({}).has_value());
  CHECK_FALSE(analysis::mantel_haenszel(Pairs{{{25, 25}, {25, 15}}}).has_value());
  CHECK_FALSE(analysis::mantel_haenszel(Pairs{{{25, 15}, {25, 25}}}).has_value());
  CHECK_FALSE(analysis::mantel_haenszel(Pairs{{{25, 0}, {25, 0}}}).has_value());
}

TEST_CASE("mantel_haenszel refuses what cannot be") {
  CHECK_THROWS_AS(analysis::mantel_haenszel(Pairs{{{5, 6}, {5, 5}}}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::mantel_haenszel(Pairs{{{5, 5}, {5, -1}}}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::mantel_haenszel({}, 1.0), std::invalid_argument);
}

}  // namespace touchtrial

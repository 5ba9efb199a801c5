#include "analysis/statistics/paired_tests.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial {

TEST_CASE("compare_methods takes the second method from the first") {
  const std::vector<analysis::PairedAccuracy> participants{
      {0.9, 0.7}, {0.8, 0.7}, {0.75, 0.8}, {0.85, 0.7}, {1.0, 0.7}};
  const analysis::MethodComparison comparison = analysis::compare_methods(participants);
  CHECK(comparison.participants == 5);
  CHECK(comparison.difference.value() == Approx(0.14).margin(1e-12));
  // SciPy 1.10: mean -+ t.ppf(0.975, 4) * std(ddof=1) / sqrt(5) of .2 .1 -.05 .15 .3
  CHECK(comparison.interval.low == Approx(-0.020698378536599865).margin(1e-12).epsilon(0));
  CHECK(comparison.interval.high == Approx(0.30069837853659986).margin(1e-12).epsilon(0));
  CHECK(comparison.p == 0.125);
  CHECK(comparison.bootstrap->low < 0.14);
  CHECK(comparison.bootstrap->low > -0.05);
  CHECK(comparison.bootstrap->high > 0.14);
  CHECK(comparison.bootstrap->high < 0.3);
  CHECK(comparison.db.value() == Approx(10.0 * std::log10(4.3 / 3.6)).margin(1e-12));
}

TEST_CASE("Decibels are ten times the logarithm of a ratio of accuracies") {
  CHECK(analysis::decibels(1.0, 0.1).value() == Approx(10.0).margin(1e-12));
  CHECK(analysis::decibels(0.9, 0.9) == 0.0);
  // The published improvement of 0.4 dB is a factor of about 1.096.
  CHECK(analysis::decibels(1.0964781961431851, 1.0).value() == Approx(0.4).margin(1e-12));
}

TEST_CASE("Decibels do not exist where an accuracy is zero") {
  CHECK_FALSE(analysis::decibels(0.5, 0.0).has_value());
  CHECK_FALSE(analysis::decibels(0.0, 0.5).has_value());
}

TEST_CASE("compare_methods has no interval with fewer than two participants") {
  const analysis::MethodComparison none = analysis::compare_methods({});
  CHECK_FALSE(none.difference.has_value());
  CHECK_FALSE(none.p.has_value());
  CHECK_FALSE(none.db.has_value());
  const std::vector<analysis::PairedAccuracy> one{{1.0, 0.5}};
  CHECK(analysis::compare_methods(one).difference == 0.5);
  CHECK(analysis::compare_methods(one).interval == analysis::Interval{-1.0, 1.0});
  CHECK_FALSE(analysis::compare_methods(one).known_interval());
  CHECK(analysis::compare_methods(one).p == 1.0);
  CHECK_FALSE(analysis::compare_methods(one).bootstrap.has_value());
}

TEST_CASE("compare_methods refuses values that are not finite") {
  const std::vector<analysis::PairedAccuracy> bad{{std::nan(""), 0.5}};
  CHECK_THROWS_AS(analysis::compare_methods(bad), std::invalid_argument);
}

TEST_CASE("rounding leaves no difference where there is none") {
  // 0.1 + 0.2 is not exactly 0.3 in binary, nor are these differences equal.
  const std::vector<analysis::PairedAccuracy> same{
      {0.1 + 0.2, 0.3}, {0.7, 0.1 + 0.6}, {0.8, 0.1 + 0.7}};
  const analysis::MethodComparison comparison = analysis::compare_methods(same);
  CHECK(comparison.difference == 0.0);
  CHECK(comparison.db == 0.0);
  CHECK_FALSE(comparison.known_interval());
  CHECK(comparison.bootstrap == analysis::Interval{0.0, 0.0});
}

namespace {

/// The definition: every pattern listed.
double p_by_listing(const std::vector<double>& differences) {
  double observed = 0.0;
  for (const double d : differences) observed += d;
  const unsigned patterns = 1U << differences.size();
  unsigned as_far = 0;
  for (unsigned pattern = 0; pattern < patterns; ++pattern) {
    double sum = 0.0;
    for (std::size_t k = 0; k < differences.size(); ++k) {
      sum += (pattern >> k & 1U) != 0 ? -differences[k] : differences[k];
    }
    if (std::abs(sum) >= std::abs(observed) - 1e-9) ++as_far;
  }
  return static_cast<double>(as_far) / patterns;
}

}  // namespace

TEST_CASE("sign_flip_p cannot go below two patterns of all") {
  for (int n = 1; n <= analysis::kExactSignFlips; ++n) {
    const std::vector<double> same_sign(static_cast<std::size_t>(n), 0.04);
    CHECK(analysis::sign_flip_p(same_sign) == std::ldexp(2.0, -n));
  }
}

TEST_CASE("sign_flip_p agrees with listing every pattern, ties included") {
  RandomStream random(3, "differences");
  for (int n = 1; n <= 12; ++n) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::vector<double> differences;
      for (int i = 0; i < n; ++i) {
        differences.push_back((static_cast<double>(random.below(9)) - 4.0) / 25.0);
      }
      REQUIRE(analysis::sign_flip_p(differences).value() == p_by_listing(differences));
    }
  }
}

TEST_CASE("sign_flip_p is 1 where nothing differs") {
  const std::vector<double> zeros(10, 0.0);
  CHECK(analysis::sign_flip_p(zeros) == 1.0);
  const std::vector<double> balanced{0.2, -0.2};
  CHECK(analysis::sign_flip_p(balanced) == 1.0);
  CHECK_FALSE(analysis::sign_flip_p({}).has_value());
}

TEST_CASE("Beyond the exact range sign_flip_p samples, the same way every time") {
  // 40 differences of one size: p is twice a binomial tail, P(X >= 27) for X ~ B(40, 1/2).
  std::vector<double> differences(27, 0.1);
  differences.resize(40, -0.1);
  double tail = 0.0;
  for (int x = 27; x <= 40; ++x) {
    tail += std::exp(std::lgamma(41) - std::lgamma(x + 1) - std::lgamma(41 - x)) * 0x1p-40;
  }
  const double p = analysis::sign_flip_p(differences).value();
  CHECK(p == Approx(2.0 * tail).margin(5.0 * std::sqrt(2.0 * tail / 1e5)).epsilon(0));
  CHECK(analysis::sign_flip_p(differences) == p);
  const std::vector<double> extreme(40, 0.1);
  CHECK(analysis::sign_flip_p(extreme) == 1e-5);
}

TEST_CASE("sign_flip_p refuses values that are not finite") {
  const std::vector<double> bad{0.1, std::numeric_limits<double>::infinity()};
  CHECK_THROWS_AS(analysis::sign_flip_p(bad), std::invalid_argument);
}

TEST_CASE("sign_flip_attainable is the largest p within the level over all patterns of signs") {
  RandomStream random(11, "sign_flip_attainable");
  for (int repetition = 0; repetition < 40; ++repetition) {
    std::vector<double> differences(6 + random.below(4));
    for (double& one : differences) one = 0.05 * static_cast<double>(random.below(7));
    double largest = 0.0;
    for (std::uint64_t pattern = 0; pattern < (1U << differences.size()); ++pattern) {
      std::vector<double> flipped = differences;
      for (std::size_t i = 0; i < flipped.size(); ++i) {
        if ((pattern >> i & 1U) != 0) flipped[i] = -flipped[i];
      }
      const double p = *analysis::sign_flip_p(flipped);
      if (p <= 0.05) largest = std::max(largest, p);
    }
    CHECK(analysis::sign_flip_attainable(differences, 0.05) == largest);
  }
}

TEST_CASE("beyond the exact range sign_flip_attainable is just below the level") {
  // Differences of two kinds alone: sums are coarse, and many tie.
  std::vector<double> differences(40, 0.5);
  for (std::size_t i = 0; i < 20; ++i) differences[i] = 0.25;
  const double reached = analysis::sign_flip_attainable(differences, 0.05);
  CHECK(reached <= 0.05);
  CHECK(reached > 0.03);
  double largest = 0.0;
  for (int flipped = 0; flipped <= 40; ++flipped) {
    std::vector<double> some = differences;
    for (int i = 0; i < flipped; ++i) some[i] = -some[i];
    const double p = *analysis::sign_flip_p(some);
    if (p <= 0.05) largest = std::max(largest, p);
  }
  CHECK(largest <= reached);
}

TEST_CASE("sign_flip_attainable is 0 at 5 % with five participants or without differences") {
  CHECK(analysis::sign_flip_attainable(std::vector<double>(5, 0.2), 0.05) == 0.0);
  CHECK(analysis::sign_flip_attainable(std::vector<double>(12, 0.0), 0.05) == 0.0);
  CHECK(analysis::sign_flip_attainable(std::vector<double>(6, 0.2), 0.05) == 2.0 / 64.0);
}

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

TEST_CASE("Participants with nothing wrong, or without trials, change no odds ratio") {
  Pairs participants{{{25, 20}, {25, 15}}};
  const analysis::OddsRatio before = *analysis::mantel_haenszel(participants);
  participants.push_back({{25, 25}, {25, 25}});
  participants.push_back({{0, 0}, {0, 0}});
  participants.push_back({{25, 3}, {0, 0}});
  CHECK(analysis::mantel_haenszel(participants)->estimate == Approx(before.estimate));
}

TEST_CASE("An odds ratio that is 0 or infinite does not exist") {
  CHECK_FALSE(analysis::mantel_haenszel({}).has_value());
  CHECK_FALSE(analysis::mantel_haenszel(Pairs{{{25, 25}, {25, 15}}}).has_value());
  CHECK_FALSE(analysis::mantel_haenszel(Pairs{{{25, 15}, {25, 25}}}).has_value());
  CHECK_FALSE(analysis::mantel_haenszel(Pairs{{{25, 0}, {25, 0}}}).has_value());
}

TEST_CASE("mantel_haenszel refuses impossible arguments") {
  CHECK_THROWS_AS(analysis::mantel_haenszel(Pairs{{{5, 6}, {5, 5}}}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::mantel_haenszel(Pairs{{{5, 5}, {5, -1}}}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::mantel_haenszel({}, 1.0), std::invalid_argument);
}

namespace {

/// The definition: every way in which `pairs` disagreements could have fallen.
double p_by_listing(int first_only, int second_only) {
  const int pairs = first_only + second_only;
  const int observed = std::abs(first_only - second_only);
  double p = 0.0;
  for (unsigned pattern = 0; pattern < 1U << pairs; ++pattern) {
    int excess = -pairs;
    for (int k = 0; k < pairs; ++k) excess += (pattern >> k & 1U) != 0 ? 2 : 0;
    if (std::abs(excess) > observed) p += 1.0;
    if (std::abs(excess) == observed) p += 0.5;
  }
  return std::ldexp(p, -pairs);
}

}  // namespace

TEST_CASE("mcnemar_mid_p equals the listing of all outcomes and does not depend on the order") {
  for (int first = 0; first <= 8; ++first) {
    for (int second = first == 0 ? 1 : 0; second <= 8; ++second) {
      CHECK(analysis::mcnemar_mid_p(first, second) ==
            Approx(p_by_listing(first, second)).epsilon(1e-12));
      CHECK(analysis::mcnemar_mid_p(first, second) == analysis::mcnemar_mid_p(second, first));
    }
  }
}

TEST_CASE("mcnemar_mid_p is 1 where no pair disagrees, and refuses impossible counts") {
  CHECK(analysis::mcnemar_mid_p(0, 0) == 1.0);
  CHECK_THROWS_AS(analysis::mcnemar_mid_p(-1, 3), std::invalid_argument);
  CHECK_THROWS_AS(analysis::mcnemar_mid_p(3, -1), std::invalid_argument);
}

// Expected values: statsmodels 0.13, multipletests(p, method="holm").
TEST_CASE("holm_adjusted gives the values of an independent implementation") {
  const std::vector<double> p{0.01, 0.04, 0.03, 0.005, 0.5};
  const std::vector<double> expected{0.04, 0.09, 0.09, 0.025, 0.5};
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  REQUIRE(adjusted.size() == expected.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    CHECK(adjusted[i] == Approx(expected[i]).epsilon(1e-14));
  }
}

TEST_CASE("holm_adjusted lies between p and Bonferroni's, keeps the order and ends at 1") {
  const std::vector<double> p{0.6, 0.012, 0.012, 0.9, 0.0, 1.0};
  const std::vector<double> adjusted = analysis::holm_adjusted(p);
  for (std::size_t i = 0; i < p.size(); ++i) {
    CHECK(adjusted[i] >= p[i]);
    CHECK(adjusted[i] <= std::min(1.0, 6.0 * p[i]));
    for (std::size_t j = 0; j < p.size(); ++j) {
      if (p[i] <= p[j]) CHECK(adjusted[i] <= adjusted[j]);
    }
  }
}

TEST_CASE("holm_adjusted leaves a single p as it is, and nothing as nothing") {
  CHECK(analysis::holm_adjusted(std::vector<double>{0.03}) == std::vector<double>{0.03});
  CHECK(analysis::holm_adjusted({}).empty());
}

TEST_CASE("holm_adjusted refuses numbers that are not probabilities") {
  CHECK_THROWS_AS(analysis::holm_adjusted(std::vector<double>{0.1, 1.1}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::holm_adjusted(std::vector<double>{-0.1}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::holm_adjusted(std::vector<double>{std::nan("")}),
                  std::invalid_argument);
}

// Expected values: statsmodels 0.13, multipletests with "fdr_bh".
TEST_CASE("benjamini_hochberg_adjusted gives Benjamini and Hochberg's values, in the order given") {
  const std::vector<double> adjusted =
      analysis::benjamini_hochberg_adjusted(std::vector<double>{0.01, 0.04, 0.03, 0.5});
  CHECK(adjusted[0] == Approx(0.04));
  CHECK(adjusted[1] == Approx(0.16 / 3.0));
  CHECK(adjusted[2] == Approx(0.16 / 3.0));
  CHECK(adjusted[3] == Approx(0.5));
  CHECK(analysis::benjamini_hochberg_adjusted({}).empty());
  CHECK_THROWS_AS(analysis::benjamini_hochberg_adjusted(std::vector<double>{1.1}),
                  std::invalid_argument);
}

TEST_CASE("benjamini_hochberg_adjusted is never above Holm's adjustment, and never below p") {
  RandomStream random(1, "discovery");
  for (int round = 0; round < 50; ++round) {
    std::vector<double> p(1 + random.below(12));
    for (double& one : p) one = random.uniform() * random.uniform();
    const std::vector<double> discovery = analysis::benjamini_hochberg_adjusted(p);
    const std::vector<double> holm = analysis::holm_adjusted(p);
    for (std::size_t i = 0; i < p.size(); ++i) {
      CHECK(discovery[i] >= p[i]);
      CHECK(discovery[i] <= holm[i] + 1e-15);
    }
  }
}

TEST_CASE("the odds ratio's interval over participants inverts with the methods") {
  std::vector<std::pair<analysis::Proportion, analysis::Proportion>> there;
  std::vector<std::pair<analysis::Proportion, analysis::Proportion>> back;
  for (int i = 0; i < 12; ++i) {
    there.emplace_back(analysis::Proportion{25, 15 + i % 7}, analysis::Proportion{25, 12 + i % 5});
    back.emplace_back(there.back().second, there.back().first);
  }
  const analysis::Interval one = analysis::odds_ratio_bootstrap(there).value();
  const analysis::Interval other = analysis::odds_ratio_bootstrap(back).value();
  CHECK(other.low == Approx(1.0 / one.high));
  CHECK(other.high == Approx(1.0 / one.low));
  const double estimate = analysis::mantel_haenszel(there)->estimate;
  CHECK(one.low < estimate);
  CHECK(one.high > estimate);
}

TEST_CASE("people who differ in their odds ratio widen its interval over participants alone") {
  // Half are better with the first method, half with the second, by as much.
  std::vector<std::pair<analysis::Proportion, analysis::Proportion>> people;
  for (int i = 0; i < 20; ++i) {
    const analysis::Proportion good{25, 22};
    const analysis::Proportion bad{25, 10};
    people.emplace_back(i % 2 == 0 ? good : bad, i % 2 == 0 ? bad : good);
  }
  const analysis::Interval trials = analysis::mantel_haenszel(people)->interval;
  const analysis::Interval over = analysis::odds_ratio_bootstrap(people).value();
  CHECK(std::log(over.high / over.low) > 2.0 * std::log(trials.high / trials.low));
}

}  // namespace touchtrial

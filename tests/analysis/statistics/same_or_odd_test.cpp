#include "analysis/statistics/same_or_odd.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>

namespace touchtrial {

// Expected values: the examples in the help texts of Palamedes (Prins, Kingdom 2018), functions
// PAL_SDT_1AFCsameDiff_DiffMod_PHFtoDP and PAL_SDT_1AFCsameDiff_IndMod_PHFtoDP.
TEST_CASE("same-different sensitivities are those of Palamedes") {
  CHECK(analysis::differencing_d_prime({0.6, 0.1})->d_prime == Approx(2.6837).margin(5e-5));
  CHECK(analysis::differencing_d_prime({0.7, 0.1})->d_prime == Approx(3.0675).margin(5e-5));
  CHECK(analysis::differencing_d_prime({0.8, 0.5})->d_prime == Approx(2.0629).margin(5e-5));
  CHECK(analysis::differencing_d_prime({0.6, 0.1})->criterion == Approx(2.3262).margin(5e-5));
  CHECK(analysis::independent_d_prime({0.6, 0.1})->d_prime == Approx(2.2835).margin(5e-5));
  CHECK(analysis::independent_d_prime({0.8, 0.1})->d_prime == Approx(2.8342).margin(5e-5));
  CHECK(analysis::independent_d_prime({0.9, 0.6})->d_prime == Approx(1.7808).margin(5e-5));
  CHECK(analysis::independent_d_prime({0.6, 0.1})->criterion == Approx(0.5141).margin(5e-5));
  CHECK(analysis::independent_d_prime({0.9, 0.6})->criterion == Approx(-0.7674).margin(5e-5));
}

TEST_CASE("same-different sensitivity is 0 without any, and nothing below chance") {
  CHECK(analysis::differencing_d_prime({0.3, 0.3})->d_prime == Approx(0.0).margin(1e-6));
  CHECK(analysis::independent_d_prime({0.3, 0.3})->d_prime == Approx(0.0).margin(1e-12));
  CHECK_FALSE(analysis::differencing_d_prime({0.2, 0.3}));
  CHECK_FALSE(analysis::independent_d_prime({0.2, 0.3}));
  CHECK_THROWS_AS(analysis::differencing_d_prime({1.0, 0.3}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::independent_d_prime({0.5, 0.0}), std::invalid_argument);
}

TEST_CASE("the odd one of three is found as often as simulated observers find it") {
  RandomStream random(1, "odd one");
  for (const double d : {0.0, 1.0, 2.0, 4.0}) {
    constexpr int kTrials = 200'000;
    int far = 0;
    int likely = 0;
    for (int i = 0; i < kTrials; ++i) {
      const double odd = 0.5 * d + random.normal();
      const double a = -0.5 * d + random.normal();
      const double b = -0.5 * d + random.normal();
      const double alike = std::abs(a - b);
      if (alike < std::abs(a - odd) && alike < std::abs(b - odd)) ++far;
      // The likelihood that one is odd, whichever stimulus it is, rises with this distance.
      const auto evidence = [](double one, double x, double y) { return std::abs(one - x - y); };
      if (evidence(odd, a, b) > evidence(a, odd, b) && evidence(odd, a, b) > evidence(b, odd, a)) {
        ++likely;
      }
    }
    const double error = 4.0 * std::sqrt(0.25 / kTrials);
    using analysis::OddOneRule;
    CHECK(analysis::odd_one_share_of(d, OddOneRule::differencing) ==
          Approx(static_cast<double>(far) / kTrials).margin(error));
    CHECK(analysis::odd_one_share_of(d, OddOneRule::independent) ==
          Approx(static_cast<double>(likely) / kTrials).margin(error));
  }
}

// Expected values: the example in the help text of Palamedes, function
// PAL_SDT_3AFCoddity_IndMod_PCtoDP.
TEST_CASE("the independent observer of the odd one is that of Palamedes") {
  const double expected[] = {1.2451, 1.6686, 2.1012, 2.6060, 3.3245};
  for (int i = 0; i < 5; ++i) {
    CHECK(*analysis::odd_one_d_prime(0.5 + 0.1 * i, analysis::OddOneRule::independent) ==
          Approx(expected[i]).margin(1e-4));
  }
}

TEST_CASE("odd_one_d_prime is the inverse") {
  for (const auto rule : {analysis::OddOneRule::differencing, analysis::OddOneRule::independent}) {
    for (double d = 0.1; d < 6.0; d += 0.3) {
      CHECK(*analysis::odd_one_d_prime(analysis::odd_one_share_of(d, rule), rule) ==
            Approx(d).margin(1e-6));
    }
    CHECK(analysis::odd_one_share_of(0.0, rule) == Approx(1.0 / 3.0).margin(1e-9));
    CHECK(analysis::odd_one_share_of(1000.0, rule) == Approx(1.0));
    CHECK(*analysis::odd_one_d_prime(0.2, rule) == 0.0);
    CHECK_FALSE(analysis::odd_one_d_prime(1.0, rule));
    CHECK_THROWS_AS(analysis::odd_one_d_prime(1.5, rule), std::invalid_argument);
  }
}

}  // namespace touchtrial

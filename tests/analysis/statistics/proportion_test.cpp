#include "analysis/statistics/proportion.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>

namespace touchtrial {
namespace {

using namespace analysis;

void check_interval(const Interval& interval, double low, double high) {
  CHECK(interval.low == Approx(low).margin(1e-12).epsilon(0));
  CHECK(interval.high == Approx(high).margin(1e-12).epsilon(0));
}

}  // namespace

// Expected values: SciPy 1.10, binomtest(x, n).proportion_ci(0.95, method), printed with repr.
TEST_CASE("wilson_interval gives the published values") {
  check_interval(wilson_interval({25, 20}), 0.6086904963045967, 0.9113941531319742);
  check_interval(wilson_interval({5, 5}), 0.5655175352168251, 1.0);
  check_interval(wilson_interval({25, 0}), 0.0, 0.1331922509390485);
  check_interval(wilson_interval({1, 1}), 0.20654931437723745, 1.0);
  check_interval(wilson_interval({500, 312}), 0.5807491793847674, 0.6653599841807676);
  check_interval(wilson_interval({25, 20}, 0.99), 0.5433887449500434, 0.9307711737365814);
}

// Expected values: SciPy 1.10, beta.ppf(0.025, x, n - x + 1) and beta.ppf(0.975, x + 1, n - x).
TEST_CASE("clopper_pearson_interval gives the published values") {
  check_interval(clopper_pearson_interval({25, 20}), 0.5929625677213227, 0.931688535987516);
  check_interval(clopper_pearson_interval({5, 5}), 0.47817624989501856, 1.0);
  check_interval(clopper_pearson_interval({5, 0}), 0.0, 0.5218237501049814);
  check_interval(clopper_pearson_interval({25, 0}), 0.0, 0.1371851715307125);
  check_interval(clopper_pearson_interval({500, 312}), 0.5799100135495965, 0.6666144274829651);
  check_interval(clopper_pearson_interval({25, 20}, 0.99), 0.5302422820158431, 0.9541146545210458);
}

// Expected values: SciPy 1.10, beta.ppf of x + 0.5 and n - x + 0.5.
TEST_CASE("jeffreys_interval gives the values of an independent implementation") {
  check_interval(jeffreys_interval({25, 20}), 0.6157982096565614, 0.9193213125361809);
  check_interval(jeffreys_interval({5, 5}), 0.6206228577009606, 1.0);
  check_interval(jeffreys_interval({25, 0}), 0.0, 0.0946827641095835);
  check_interval(jeffreys_interval({1, 1}), 0.1467463163095751, 1.0);
  check_interval(jeffreys_interval({500, 312}), 0.5809264727053622, 0.6656426174301);
  check_interval(jeffreys_interval({25, 20}, 0.99), 0.5530311238639567, 0.9442386786366499);
}

TEST_CASE("Without trials an interval is the whole scale") {
  CHECK(jeffreys_interval({0, 0}) == Interval{0.0, 1.0});
  CHECK(wilson_interval({0, 0}) == Interval{0.0, 1.0});
  CHECK(clopper_pearson_interval({0, 0}) == Interval{0.0, 1.0});
  CHECK_FALSE(Proportion{}.share().has_value());
}

TEST_CASE("Intervals reach the end of the scale exactly and mirror each other") {
  for (int n = 1; n <= 60; ++n) {
    CHECK(wilson_interval({n, 0}).low == 0.0);
    CHECK(wilson_interval({n, n}).high == 1.0);
    for (int correct = 0; correct <= n; ++correct) {
      const Interval wilson = wilson_interval({n, correct});
      const Interval exact = clopper_pearson_interval({n, correct});
      const double p = static_cast<double>(correct) / n;
      REQUIRE(wilson.low <= p);
      REQUIRE(p <= wilson.high);
      REQUIRE(exact.low <= p);
      REQUIRE(p <= exact.high);
      const Interval jeffreys = jeffreys_interval({n, correct});
      REQUIRE(exact.low <= jeffreys.low);
      REQUIRE(jeffreys.low <= p);
      REQUIRE(p <= jeffreys.high);
      REQUIRE(jeffreys.high <= exact.high);
      const Interval mirrored = clopper_pearson_interval({n, n - correct});
      REQUIRE(exact.low == Approx(1.0 - mirrored.high).margin(1e-12));
    }
  }
}

TEST_CASE("Impossible proportions are refused") {
  CHECK_THROWS_AS(wilson_interval({5, 6}), std::invalid_argument);
  CHECK_THROWS_AS(wilson_interval({5, -1}), std::invalid_argument);
  CHECK_THROWS_AS(jeffreys_interval({5, 6}), std::invalid_argument);
  CHECK_THROWS_AS(jeffreys_interval({5, 5}, 0.0), std::invalid_argument);
  CHECK_THROWS_AS(clopper_pearson_interval({5, 6}), std::invalid_argument);
  CHECK_THROWS_AS(clopper_pearson_interval({5, 5}, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(wilson_interval({5, 5}, std::nan("")), std::invalid_argument);
}

}  // namespace touchtrial

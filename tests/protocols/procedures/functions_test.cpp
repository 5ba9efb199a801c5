#include "protocols/procedures/psychometric_function.hpp"
#include "support/catch.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::procedures;

TEST_CASE("psychometric functions have the shares that their definitions state") {
  const Observer weibull{Shape::weibull, -20.0, 3.5, 0.5, 0.02};
  CHECK(shares_at(weibull, -20.0).correct == Approx(0.5 + 0.48 * (1.0 - std::exp(-1.0))));
  // Watson 2017: 1 - lapse - (1 - guess - lapse) exp(-10^(beta (x - t) / 20)).
  for (double x = -30.0; x <= -5.0; x += 1.0) {
    const double watson = 0.98 - 0.48 * std::exp(-std::pow(10.0, 3.5 * (x + 20.0) / 20.0));
    CHECK(shares_at(weibull, x).correct == Approx(watson).margin(1e-13));
    CHECK(shares_at(weibull, x).correct + shares_at(weibull, x).wrong == Approx(1.0).margin(1e-13));
  }
  CHECK(shares_at({Shape::logistic, 0.0, 2.0, 0.0, 0.0}, 1.0).correct ==
        Approx(1.0 / (1.0 + std::exp(-2.0))));
  CHECK(shares_at({Shape::normal, 0.0, 1.0, 0.0, 0.0}, 1.959963984540054).correct ==
        Approx(0.975).margin(1e-12));
}

TEST_CASE("level_at is the inverse of shares_at at every criterion") {
  for (const Shape shape : {Shape::logistic, Shape::weibull, Shape::normal}) {
    const Observer observer{shape, -12.0, 1.3, 1.0 / 3.0, 0.03};
    for (double p = 0.35; p < 0.96; p += 0.05) {
      CHECK(shares_at(observer, level_at(observer, p)).correct == Approx(p).margin(1e-12));
    }
    const double at =
        observer.guess + (1 - observer.guess - observer.lapse) * share_at_threshold(shape);
    CHECK(level_at(observer, at) == Approx(-12.0).margin(1e-9));
    CHECK_THROWS_AS(level_at(observer, 0.98), std::invalid_argument);
    CHECK_THROWS_AS(level_at(observer, 1.0 / 3.0), std::invalid_argument);
  }
}

TEST_CASE("logarithms of shares stay finite where shares underflow") {
  // Expected: log Phi(-40) as SciPy documents it for log_ndtr.
  CHECK(log_shares_at({Shape::normal, 0.0, 1.0, 0.0, 0.0}, -40.0).correct ==
        Approx(-804.6084420137538).epsilon(1e-11));
  CHECK(log_shares_at({Shape::logistic, 0.0, 1.0, 0.0, 0.0}, -1000.0).correct == Approx(-1000.0));
  CHECK(log_shares_at({Shape::logistic, 0.0, 1.0, 0.0, 0.0}, 1000.0).wrong == Approx(-1000.0));
  const Observer weibull{Shape::weibull, 0.0, 1.0, 0.0, 0.0};
  CHECK(log_shares_at(weibull, -2000.0).correct == Approx(-100.0 * std::log(10.0)));
  CHECK(log_shares_at(weibull, 60.0).wrong == Approx(-1000.0));
  for (const Shape shape : {Shape::logistic, Shape::weibull, Shape::normal}) {
    const Observer two_intervals{shape, 0.0, 1.0, 0.5, 0.02};
    CHECK(shares_at(two_intervals, std::numeric_limits<double>::infinity()).correct ==
          Approx(0.98));
    CHECK(shares_at(two_intervals, -std::numeric_limits<double>::infinity()).correct ==
          Approx(0.5));
    // The two ways to log F join without a step.
    const Observer bare{shape, 0.0, 1.0, 0.0, 0.0};
    for (double x = -29.0; x > -32.0; x -= 0.25) {
      const double slope = (log_shares_at(bare, x).correct - log_shares_at(bare, x - 1e-3).correct);
      CHECK(slope > 0.0);
      CHECK(slope < 0.04);
    }
  }
}

TEST_CASE("log_likelihood takes 0 log 0 as 0, and deviance is 0 at the data's own shares") {
  const Observer never{Shape::logistic, 0.0, 1.0, 0.0, 0.0};
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(log_likelihood(never, std::array{LevelCounts{infinite, 5, 5}}) == 0.0);
  CHECK(log_likelihood(never, std::array{LevelCounts{infinite, 4, 5}}) == -infinite);
  CHECK(log_likelihood(never, std::array{LevelCounts{0.0, 3, 7}}) == Approx(7.0 * std::log(0.5)));
  CHECK(deviance(never, std::array{LevelCounts{0.0, 5, 10}}) == Approx(0.0).margin(1e-12));
}

TEST_CASE("impossible observers are refused, and a Weber fraction is an amplitude's") {
  CHECK_THROWS_AS(require_possible({Shape::weibull, NAN, 1.0, 0.5, 0.0}), std::invalid_argument);
  CHECK_THROWS_AS(require_possible({Shape::weibull, 0.0, 0.0, 0.5, 0.0}), std::invalid_argument);
  CHECK_THROWS_AS(require_possible({Shape::weibull, 0.0, 1.0, 0.5, 0.5}), std::invalid_argument);
  CHECK(weber_fraction(-20.0) == Approx(0.1));
}

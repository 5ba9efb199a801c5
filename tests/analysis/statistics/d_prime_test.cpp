#include "analysis/statistics/d_prime.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial {

// Expected values: SciPy 1.10, quad(lambda u: norm.pdf(u) * norm.cdf(u + d)**4, -12, 12) at 1e-14.
TEST_CASE("proportion_correct_of gives the published values for five alternatives") {
  CHECK(analysis::proportion_correct_of(1.0, 5) == Approx(0.49369886247273564).margin(1e-10));
  CHECK(analysis::proportion_correct_of(2.0, 5) == Approx(0.7878389827095882).margin(1e-10));
  CHECK(analysis::proportion_correct_of(3.0, 5) == Approx(0.9453113267101984).margin(1e-10));
  CHECK(analysis::proportion_correct_of(-1.0, 5) == Approx(0.04678562774305576).margin(1e-10));
}

// Expected values: the example in the help text of Palamedes, function PAL_SDT_MAFC_DPtoPC.
TEST_CASE("proportion_correct_of gives the values of Palamedes for 25 alternatives") {
  const double expected[] = {0.0400, 0.1997, 0.5218, 0.8263, 0.9648, 0.9961};
  for (int d = 0; d <= 5; ++d) {
    CHECK(analysis::proportion_correct_of(d, 25) == Approx(expected[d]).margin(5e-5));
  }
}

TEST_CASE("proportion_correct_of is chance at d' = 0 and the normal integral for two") {
  for (int m = 2; m <= 12; ++m) CHECK(analysis::proportion_correct_of(0.0, m) == Approx(1.0 / m));
  for (double d = -4.0; d <= 6.0; d += 0.5) {
    CHECK(analysis::proportion_correct_of(d, 2) == Approx(0.5 * std::erfc(-d / 2.0)).margin(1e-10));
  }
}

TEST_CASE("proportion_correct_of rises with d' and stays within 0 and 1 at the extremes") {
  double before = 0.0;
  for (double d = -5.0; d <= 8.0; d += 0.25) {
    const double share = analysis::proportion_correct_of(d, 5);
    CHECK(share > before);
    before = share;
  }
  CHECK(analysis::proportion_correct_of(-1000.0, 5) == 0.0);
  CHECK(analysis::proportion_correct_of(1000.0, 5) == Approx(1.0).margin(1e-10));
  CHECK(analysis::proportion_correct_of(1000.0, 5) <= 1.0);
}

// Expected values: SciPy 1.10, brentq over the integral above; limits from beta.ppf.
TEST_CASE("d_prime gives the values of an independent implementation") {
  const analysis::DPrime most = analysis::d_prime({25, 20}, 5);
  CHECK(*most.estimate == Approx(2.0527966347729554).margin(1e-9));
  CHECK(*most.low == Approx(1.3064916304898286).margin(1e-9));
  CHECK(*most.high == Approx(2.8586957355343805).margin(1e-9));
  const analysis::DPrime one = analysis::d_prime({25, 1}, 5);
  CHECK(*one.estimate == Approx(-1.08792326135048).margin(1e-9));
  CHECK(*one.low == Approx(-2.667742381239923).margin(1e-9));
  CHECK(*one.high == Approx(0.015042768928057228).margin(1e-9));
}

TEST_CASE("d_prime at the ends of the scale is a bound, never infinite") {
  const analysis::DPrime all = analysis::d_prime({25, 25}, 5);
  CHECK_FALSE(all.estimate.has_value());
  CHECK_FALSE(all.high.has_value());
  CHECK(*all.low == Approx(2.3647676591288236).margin(1e-9));
  const analysis::DPrime none = analysis::d_prime({25, 0}, 5);
  CHECK_FALSE(none.estimate.has_value());
  CHECK_FALSE(none.low.has_value());
  CHECK(*none.high == Approx(-0.3021309814868767).margin(1e-9));
  const analysis::DPrime nothing = analysis::d_prime({0, 0}, 5);
  CHECK_FALSE((nothing.estimate || nothing.low || nothing.high));
}

TEST_CASE("d_prime refuses impossible arguments") {
  CHECK_THROWS_AS(analysis::d_prime({25, 20}, 1), std::invalid_argument);
  CHECK_THROWS_AS(analysis::d_prime({25, 26}, 5), std::invalid_argument);
  CHECK_THROWS_AS(analysis::proportion_correct_of(std::nan(""), 5), std::invalid_argument);
  CHECK_THROWS_AS(analysis::proportion_correct_of(std::numeric_limits<double>::infinity(), 5),
                  std::invalid_argument);
}

TEST_CASE("d' has the limits of any interval of its share, and no limit where that has none") {
  const analysis::Interval limits{0.494, 0.945};
  const analysis::DPrime found = analysis::d_prime({25, 20}, 5, limits);
  CHECK(analysis::proportion_correct_of(found.low.value(), 5) == Approx(limits.low).margin(1e-9));
  CHECK(analysis::proportion_correct_of(found.high.value(), 5) == Approx(limits.high).margin(1e-9));
  CHECK(found.estimate == analysis::d_prime({25, 20}, 5).estimate);
  const analysis::DPrime open = analysis::d_prime({25, 20}, 5, {0.0, 1.0});
  CHECK(open.estimate.has_value());
  CHECK_FALSE(open.low.has_value());
  CHECK_FALSE(open.high.has_value());
  CHECK_THROWS_AS(analysis::d_prime({25, 20}, 5, {0.9, 0.1}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::d_prime({25, 20}, 5, {-0.1, 0.1}), std::invalid_argument);
}

}  // namespace touchtrial

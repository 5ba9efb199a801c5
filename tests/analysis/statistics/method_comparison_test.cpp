#include "analysis/statistics/method_comparison.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
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

TEST_CASE("compare_methods says how little one participant or none can tell") {
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

TEST_CASE("compare_methods refuses values that are no numbers") {
  const std::vector<analysis::PairedAccuracy> bad{{std::nan(""), 0.5}};
  CHECK_THROWS_AS(analysis::compare_methods(bad), std::invalid_argument);
}

TEST_CASE("rounding leaves no difference where there is none") {
  // 0.1 + 0.2 is no 0.3 in binary, and so are the differences.
  const std::vector<analysis::PairedAccuracy> same{
      {0.1 + 0.2, 0.3}, {0.7, 0.1 + 0.6}, {0.8, 0.1 + 0.7}};
  const analysis::MethodComparison comparison = analysis::compare_methods(same);
  CHECK(comparison.difference == 0.0);
  CHECK(comparison.db == 0.0);
  CHECK(comparison.known_interval() == analysis::Interval{0.0, 0.0});
  CHECK(comparison.bootstrap == analysis::Interval{0.0, 0.0});
}

}  // namespace touchtrial

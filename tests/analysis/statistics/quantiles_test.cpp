#include "analysis/statistics/quantiles.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial {

// Expected values: NumPy 1.24, quantile(values, share), whose default is definition 7.
TEST_CASE("quantile and quartiles give the values of an independent implementation") {
  const analysis::Quartiles result = analysis::quartiles({3.1, 0.2, 7.5, 1.1, 2.2, 9.0, 4.4, 5.0});
  CHECK(result.n == 8);
  CHECK(*result.lower == Approx(1.925).epsilon(1e-14));
  CHECK(*result.median == Approx(3.75).epsilon(1e-14));
  CHECK(*result.upper == Approx(5.625).epsilon(1e-14));
  const std::vector<double> sorted{0.2, 1.1, 2.2, 3.1, 4.4, 5.0, 7.5, 9.0};
  CHECK(*analysis::quantile(sorted, 0.1) == Approx(0.83).epsilon(1e-14));
}

TEST_CASE("quantile reaches the ends exactly and passes through the values") {
  const std::vector<double> sorted{-1.0, 0.0, 0.0, 4.0, 10.0};
  CHECK(analysis::quantile(sorted, 0.0) == -1.0);
  CHECK(analysis::quantile(sorted, 0.25) == 0.0);
  CHECK(analysis::quantile(sorted, 0.75) == 4.0);
  CHECK(analysis::quantile(sorted, 1.0) == 10.0);
}

TEST_CASE("Quartiles of one value are that value, and of none they are nothing") {
  const analysis::Quartiles one = analysis::quartiles({7.0});
  CHECK(one.lower == 7.0);
  CHECK(one.median == 7.0);
  CHECK(one.upper == 7.0);
  const analysis::Quartiles none = analysis::quartiles({});
  CHECK(none.n == 0);
  CHECK_FALSE(none.median.has_value());
}

TEST_CASE("quantile refuses impossible shares, quartiles values without an order") {
  CHECK_THROWS_AS(analysis::quantile({}, 1.1), std::invalid_argument);
  CHECK_THROWS_AS(analysis::quantile({}, std::nan("")), std::invalid_argument);
  CHECK_THROWS_AS(analysis::quartiles({1.0, std::nan("")}), std::invalid_argument);
}

}  // namespace touchtrial

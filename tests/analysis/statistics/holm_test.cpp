#include "analysis/statistics/holm.hpp"

#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial {

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

TEST_CASE("holm_adjusted refuses what is no p") {
  CHECK_THROWS_AS(analysis::holm_adjusted(std::vector<double>{0.1, 1.1}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::holm_adjusted(std::vector<double>{-0.1}), std::invalid_argument);
  CHECK_THROWS_AS(analysis::holm_adjusted(std::vector<double>{std::nan("")}),
                  std::invalid_argument);
}

}  // namespace touchtrial

#include "analysis/statistics/sign_flip.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace touchtrial {
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

// Expected values: SciPy 1.10, permutation_test((d,), mean, permutation_type="samples") with all
// patterns.
TEST_CASE("sign_flip_p gives the values of an independent implementation") {
  const std::vector<double> five{0.2, 0.1, -0.05, 0.15, 0.3};
  CHECK(analysis::sign_flip_p(five) == 0.125);
  const std::vector<double> eight{1, -2, 3, 4, -5, 6, 7, 8};
  CHECK(analysis::sign_flip_p(eight) == 0.1484375);
}

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

TEST_CASE("sign_flip_p does not care which method came first") {
  const std::vector<double> one_way{0.2, 0.1, -0.05, 0.15, 0.3, 0.12};
  std::vector<double> other_way;
  for (const double d : one_way) other_way.push_back(-d);
  CHECK(analysis::sign_flip_p(one_way) == analysis::sign_flip_p(other_way));
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

TEST_CASE("sign_flip_p refuses values that are no numbers") {
  const std::vector<double> bad{0.1, std::numeric_limits<double>::infinity()};
  CHECK_THROWS_AS(analysis::sign_flip_p(bad), std::invalid_argument);
}

TEST_CASE("what sign flips can reach is the largest p of any pattern of signs within the level") {
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

TEST_CASE("beyond the exact range what sign flips can reach is just below the level") {
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

TEST_CASE("five participants, or any number that do not differ, can reach nothing at 5 %") {
  CHECK(analysis::sign_flip_attainable(std::vector<double>(5, 0.2), 0.05) == 0.0);
  CHECK(analysis::sign_flip_attainable(std::vector<double>(12, 0.0), 0.05) == 0.0);
  CHECK(analysis::sign_flip_attainable(std::vector<double>(6, 0.2), 0.05) == 2.0 / 64.0);
}

}  // namespace touchtrial

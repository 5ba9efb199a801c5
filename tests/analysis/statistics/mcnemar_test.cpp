#include "analysis/statistics/mcnemar.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace touchtrial {
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

// Fagerland, Lydersen, Laake 2013, table 1: 1 and 7 children improved with one treatment only.
TEST_CASE("mcnemar_mid_p gives the published value") {
  CHECK(analysis::mcnemar_mid_p(1, 7) == Approx(0.0391).margin(5e-5));
}

// Expected values: SciPy 1.10, 2 binom.cdf(b, b + c, 0.5) - binom.pmf(b, b + c, 0.5).
TEST_CASE("mcnemar_mid_p gives the values of an independent implementation") {
  CHECK(analysis::mcnemar_mid_p(3, 12) == Approx(0.02127075195312501).epsilon(1e-12));
  CHECK(analysis::mcnemar_mid_p(8, 2) == Approx(0.06542968749999996).epsilon(1e-12));
}

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

}  // namespace touchtrial

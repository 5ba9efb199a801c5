#include "analysis/statistics/same_different_d_prime.hpp"

#include "support/catch.hpp"

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

}  // namespace touchtrial

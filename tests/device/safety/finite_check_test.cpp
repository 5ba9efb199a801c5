#include "device/safety/finite_check.hpp"

#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

TEST_CASE("a force, position or velocity that is no number, or absurd, is seen") {
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity(), 1e300);
  CHECK_FALSE(device::is_finite_state(device::squared_norm({0.0, bad, 0.0}), {}));
  CHECK_FALSE(device::is_finite_state(1.0, {.position_mm = {0.0, 0.0, bad}, .velocity_mm_s = {}}));
  CHECK_FALSE(device::is_finite_state(1.0, {.position_mm = {}, .velocity_mm_s = {bad, 0.0, 0.0}}));
}

TEST_CASE("numbers of any sensible size are finite") {
  CHECK(device::is_finite_state(
      1e6, {.position_mm = {-1e6, 0.0, 1e6}, .velocity_mm_s = {1e9, 0.0, 0.0}}));
}

}  // namespace
}  // namespace touchtrial

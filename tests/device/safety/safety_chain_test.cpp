#include "device/safety/safety_chain.hpp"

#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

TEST_CASE("a force within the limit passes unchanged") {
  SafetyChain safety({.max_force_n = 3.3});
  const SafeForce safe = safety.check({1.0, -2.0, 2.0}, {});
  CHECK(safe.verdict == SafetyVerdict::passed);
  CHECK(safe.force_n == Vec3{1.0, -2.0, 2.0});
}

TEST_CASE("a force past the limit is shortened in its direction") {
  SafetyChain safety({.max_force_n = 2.5});
  const SafeForce safe = safety.check({3.0, 0.0, 4.0}, {});
  CHECK(safe.verdict == SafetyVerdict::limited);
  CHECK(safe.force_n == Vec3{1.5, 0.0, 2.0});
  CHECK_FALSE(safety.faulted());
}

TEST_CASE("a force that is not finite sends zero and latches until it is re-armed") {
  const double bad = GENERATE(std::numeric_limits<double>::quiet_NaN(),
                              -std::numeric_limits<double>::infinity(), 1e300);
  SafetyChain safety({.max_force_n = 3.3});
  CHECK(safety.check({bad, 0.0, 0.0}, {}).verdict == SafetyVerdict::fault);
  CHECK(safety.check({0.0, 0.0, 1.0}, {}).force_n == Vec3{});
  CHECK(safety.faulted());
  safety.rearm();
  CHECK(safety.check({0.0, 0.0, 1.0}, {}).force_n == Vec3{0.0, 0.0, 1.0});
}

TEST_CASE("a limit that is no positive number lets no force pass") {
  const double limit_n = GENERATE(0.0, -1.0, std::numeric_limits<double>::quiet_NaN());
  CHECK(SafetyChain({.max_force_n = limit_n}).check({0.0, 0.1, 0.0}, {}).force_n == Vec3{});
}

}  // namespace
}  // namespace touchtrial

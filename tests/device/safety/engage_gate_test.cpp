#include "device/safety/engage_gate.hpp"

#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

TEST_CASE("a gate opens at the first small force, and stays open") {
  device::EngageGate gate(0.5);
  CHECK_FALSE(gate.try_open(0.26));
  CHECK_FALSE(gate.is_open());
  CHECK(gate.try_open(0.25));
  CHECK(gate.try_open(9.0));
}

TEST_CASE("a gate that was closed has to be opened anew") {
  device::EngageGate gate(0.5);
  REQUIRE(gate.try_open(0.0));
  gate.close();
  CHECK_FALSE(gate.try_open(1.0));
}

TEST_CASE("a gate without a limit opens at once, one that is not a number never") {
  CHECK(device::EngageGate(std::numeric_limits<double>::infinity()).try_open(1e9));
  CHECK_FALSE(device::EngageGate(std::numeric_limits<double>::quiet_NaN()).try_open(0.0));
}

}  // namespace
}  // namespace touchtrial

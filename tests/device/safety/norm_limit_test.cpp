#include "device/safety/norm_limit.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

TEST_CASE("a force within its norm is untouched, one past it keeps its direction") {
  CHECK(device::within_norm({0.3, -0.4, 0.0}, 0.5) == Vec3{0.3, -0.4, 0.0});
  CHECK(device::within_norm({3.0, 0.0, -4.0}, 2.5) == Vec3{1.5, 0.0, -2.0});
}

}  // namespace
}  // namespace touchtrial

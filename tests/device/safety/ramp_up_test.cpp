#include "device/safety/ramp_up.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

TEST_CASE("forces grow evenly from nothing to their full size") {
  device::RampUp ramp(0.1, 0.001);
  ramp.start();
  for (int tick = 0; tick < 100; ++tick) {
    REQUIRE(ramp.of({2.0, 0.0, -1.0}).x == Approx(2.0 * tick / 100.0).margin(1e-12));
  }
  CHECK(ramp.of({2.0, 0.0, -1.0}).x == Approx(2.0));
  CHECK(ramp.of({2.0, 0.0, -1.0}) == Vec3{2.0, 0.0, -1.0});
}

TEST_CASE("a ramp of no length lets the first force pass whole") {
  device::RampUp ramp(0.0, 0.001);
  ramp.start();
  CHECK(ramp.of({0.0, 1.0, 0.0}) == Vec3{0.0, 1.0, 0.0});
}

TEST_CASE("a ramp that is started anew begins at nothing") {
  device::RampUp ramp(0.002, 0.001);
  ramp.start();
  for (int tick = 0; tick < 5; ++tick) static_cast<void>(ramp.of({1.0, 0.0, 0.0}));
  ramp.start();
  CHECK(ramp.of({1.0, 0.0, 0.0}) == Vec3{});
}

}  // namespace
}  // namespace touchtrial

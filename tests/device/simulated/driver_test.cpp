#include "device/simulated/driver.hpp"

#include "device/flat_wall.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

TEST_CASE("the simulated device is always there, strokes a whole minute and has not stopped then") {
  CHECK(device::simulated_driver().list({}).at(0).present);
  const std::unique_ptr<device::HapticDevice> device = device::open_device("simulated", {});
  CHECK(device->info().simulated);
  FlatWall wall;
  KeptSamples kept;
  const device::ServoReport report = device::run_servo_in_virtual_time(*device, wall, kept, {});
  CHECK(report.end == device::ServoEnd::time_limit);
  CHECK(report.contact_ticks > 50'000);
  for (const device::ServoSample& sample : kept.samples) {
    REQUIRE(sample.position_mm.x > 0.0);
    REQUIRE(sample.position_mm.x < device::kSimulatedPlaneMm);
  }
}

}  // namespace
}  // namespace touchtrial

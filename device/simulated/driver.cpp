#include "device/simulated/driver.hpp"

#include "device/simulated/simulated_hand.hpp"

namespace touchtrial::device {
namespace {

constexpr double kPitchMm = 0.2;
constexpr int kPlanePx = static_cast<int>(kSimulatedPlaneMm / kPitchMm);

std::vector<DeviceListing> list_simulated(const DeviceSettings&) {
  DeviceListing listing;
  listing.driver = "simulated";
  listing.model = "simulated hand";
  listing.present = true;
  return {listing};
}

std::unique_ptr<HapticDevice> open_simulated(const DeviceSettings&) {
  RandomStream random(1, "simulated device");
  HandOptions hand;
  hand.explore_s = kSimulatedExploreS;
  ExplorationOptions exploration;
  exploration.duration_s = kSimulatedExploreS;
  const PlaneGeometry plane{kPitchMm, kPlanePx, kPlanePx};
  return std::make_unique<SimulatedHand>(hand, ExplorationPath(plane, exploration, random));
}

}  // namespace

DeviceDriver simulated_driver() {
  return {"simulated", "a simulated hand that strokes a blank plane", list_simulated,
          open_simulated};
}

}  // namespace touchtrial::device

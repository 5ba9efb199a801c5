#include "device/falcon/emulator/hand_on_falcon.hpp"

#include "device/falcon/emulator/falcon_host.hpp"
#include "device/falcon/falcon_motors.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial::device::falcon {
namespace {

constexpr PlaneGeometry kPlane{0.08, 500, 500};  // 40 mm
const device::PlanePlacement kTable{device::PlaneOrientation::horizontal, {-20.0, -10.0, -20.0}};
const device::PlanePlacement kWall{device::PlaneOrientation::vertical, {-20.0, 20.0, -10.0}};
constexpr double kWallNPerMm = 0.4;

device::SimulatedHand hand_for(double explore_s) {
  RandomStream random(1, "hand_on_falcon_test");
  device::HandOptions options;
  options.explore_s = explore_s;
  return {options, device::ExplorationPath(kPlane, {.duration_s = explore_s}, random)};
}

Vec3 wall_force_n(Vec3 plane_mm) {
  return {0.0, 0.0, plane_mm.z < 0.0 ? -kWallNPerMm * plane_mm.z : 0.0};
}

/// The simplest servo: reads, computes a flat wall, writes.
struct FlatWallServo {
  FalconHost& host;
  device::PlanePlacement placement;
  MotorValues motors{};

  /// \return the hand's place on the plane
  Vec3 tick() {
    const auto reply = host.exchange({motors, 0, true});
    REQUIRE(reply);
    motors = {};
    if (!reply->all_homed()) return {0.0, 0.0, 1000.0};
    const Pose pose = forward_kinematics(theta1_of_counts(reply->counts));
    REQUIRE(pose.status == PoseStatus::ok);
    const Vec3 plane_mm = device::to_plane_direction(
        to_device_mm(pose.native_m) - placement.origin_mm, placement.orientation);
    const Vec3 force_n = device::to_device_direction(wall_force_n(plane_mm), placement.orientation);
    motors = FalconMotors({}).command(torques_nm(pose.jacobian, force_n).value(), {}).values;
    return plane_mm;
  }
};

struct Rig {
  explicit Rig(const device::PlanePlacement& placement, bool homed)
      : hand(placement, {0.0, 15.0, 0.0}),
        falcon({.firmware_runs = true, .homed = homed, .boot_loader = {}},
               [this](Vec3 force_n) { return hand.tick(force_n); }),
        host(falcon),
        servo{host, placement} {
    host.set_up_for_running();
  }

  HandOnFalcon hand;
  FalconEmulator falcon;
  FalconHost host;
  FlatWallServo servo;
};

TEST_CASE("hand on falcon: a wall through packets and legs feels like a wall written directly") {
  const device::PlanePlacement placement = GENERATE(kTable, kWall);
  Rig rig(placement, true);
  rig.hand.explore(hand_for(2.0));
  std::vector<Vec3> felt;
  int ticks = 0;
  for (; !rig.hand.at_rest(); ++ticks) {
    REQUIRE(ticks < 10000);
    felt.push_back(rig.servo.tick());
  }
  CHECK(rig.hand.explorations() == 1);
  CHECK(rig.falcon.complaints().empty());

  device::SimulatedHand direct = hand_for(2.0);
  std::vector<Vec3> expected;
  device::DeviceSample sample;
  while (direct.read(sample) == device::DeviceStatus::ok) {
    expected.push_back(sample.position_mm);
    CHECK(direct.write(wall_force_n(sample.position_mm)) == device::DeviceStatus::ok);
  }
  // Steady on the wall, both: the same depth and the same place along the path.
  const auto landed = std::ranges::find_if(felt, [](Vec3 p) { return p.z < 0.0; });
  const auto landed_directly = std::ranges::find_if(expected, [](Vec3 p) { return p.z < 0.0; });
  REQUIRE(landed != felt.end());
  REQUIRE(landed_directly != expected.end());
  for (int i = 500; i < 1000; i += 10) {
    REQUIRE(norm(*(landed + i) - *(landed_directly + i)) < 0.3);
  }
}

}  // namespace
}  // namespace touchtrial::device::falcon

// The stylus grip as a hand: what it does to a tip, and how it explores. Its laws under sines and
// on walls are in tests/device/model.
#include "device/drivers/simulated/hand_on_tip.hpp"

#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/flat_wall.hpp"
#include "device/platform/realtime.hpp"
#include "support/catch.hpp"
#include "support/realtime_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using namespace device;

constexpr PlaneGeometry kPlane{0.2, 500, 500};

HandOptions grip(const HandFactors& factors = {}) {
  return {.model = HandKind::stylus_grip, .factors = factors};
}

/// How far a constant force moves the tip in the end.
Vec3 deflection_mm(const HandOptions& options, Vec3 force_n) {
  HeldDevice held(options, device_model("ideal"));
  for (int i = 0; i < 20'000; ++i) held.tick(force_n, {}, 0.0);
  return held.device.true_position_mm();
}

TEST_CASE("a constant force bends fingers and arm along the plane by what their springs yield") {
  const Vec3 moved_mm = deflection_mm(grip(), {0.5, 0.5, 0.0});
  CHECK(moved_mm.x == Approx(500.0 / 380.0 + 500.0 / 79.0).epsilon(1e-6));
  CHECK(moved_mm.y == Approx(500.0 / 770.0 + 500.0 / 272.0).epsilon(1e-6));
  const Vec3 stiffer_mm = deflection_mm(grip({.stiffness = 2.0}), {0.5, 0.5, 0.0});
  CHECK(stiffer_mm.x == Approx(0.5 * moved_mm.x).epsilon(1e-6));
}

TEST_CASE("across the plane the grip pushes with one force at every height") {
  const HandFactors factors{.damping = GENERATE(1.0, 2.0), .mass = 1.5};
  HeldDevice held(grip(factors), device_model("ideal"));
  for (int i = 0; i < 3000; ++i) held.tick({0.0, 0.0, 0.2}, {}, 0.7);
  CHECK(held.device.true_velocity_mm_s().z ==
        Approx(-500.0 / (6.4 * factors.damping)).epsilon(1e-6));
}

TEST_CASE("a grip stays stable on a device of any mass, however stiff the hand is") {
  DeviceModel model;
  model.mass_kg = GENERATE(0.0, 0.0001, 0.02, 5.0);
  model.zero_order_hold = GENERATE(false, true);
  const HandFactors factors{GENERATE(1.0, 20.0, 400.0), GENERATE(0.0, 1.0), 0.05};
  HeldDevice held(grip(factors), model);
  held.place({3.0, -2.0, 1.0});
  double farthest_mm = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    held.tick({}, {}, 0.0);
    farthest_mm = std::max(farthest_mm, norm(held.device.true_position_mm()));
  }
  // Without damping the tip swings further than it was, as the masses exchange their energy.
  CHECK(farthest_mm < 4.0 * norm(Vec3{3.0, -2.0, 1.0}));
}

TEST_CASE("a grip gives a device at least 0.03 kg at the tip, and no more than that") {
  const auto jump_mm_s = [](double mass_kg) {
    DeviceModel model;
    model.mass_kg = mass_kg;
    HeldDevice held(grip({0.0, 0.0, 1.0}), model);
    held.tick({3.0, 0.0, 0.0}, {}, 0.0);
    return held.device.true_velocity_mm_s().x;
  };
  CHECK(jump_mm_s(0.0) == Approx(3.0 / 0.03));
  CHECK(jump_mm_s(0.01) == Approx(3.0 / 0.03));
  CHECK(jump_mm_s(0.06) == Approx(3.0 / 0.06));
}

TEST_CASE("a hand with a grip lands, keeps its push, and follows its path") {
  HandOptions options = grip();
  options.explore_s = 6.0;
  RandomStream random(8, "hand_on_tip_test");
  const device::ExplorationPath path(kPlane, {.duration_s = options.explore_s}, random);
  device::SimulatedHand hand(options, path, device_model(GENERATE("ideal", "touch")));
  FlatWall wall;
  KeptSamples kept;
  const ServoReport report = device::run_servo_in_virtual_time(hand, wall, kept, {});
  REQUIRE(report.end == ServoEnd::hand_stopped);
  std::size_t stroke = 0;
  double farthest_mm = 0.0;
  double push_sum_n = 0.0;
  for (std::size_t i = 0; i < kept.samples.size(); ++i) {
    const Vec2 target_mm = path.at(static_cast<double>(i) * kServoTickS, stroke).position_mm;
    const Vec3 at_mm = kept.samples[i].position_mm;
    farthest_mm = std::max(farthest_mm, norm(Vec2{at_mm.x, at_mm.y} - target_mm));
    if (i >= 1500) push_sum_n += kept.samples[i].force_n.z;
  }
  CHECK(farthest_mm < 12.0);
  CHECK(push_sum_n / static_cast<double>(kept.samples.size() - 1500) ==
        Approx(options.push_n).margin(0.15));
}

TEST_CASE("a hand that foresees its way without forces, and its copies, move and feel the same") {
  class Sensed final : public TipSense {
   public:
    void feel(const Vec3& position_mm, const Vec3& /*force_n*/,
              const Vec3& acceleration_m_s2) noexcept override {
      felt.push_back(position_mm);
      felt.push_back(acceleration_m_s2);
    }
    std::vector<Vec3> felt;
  };
  const std::string name = GENERATE("ideal", "touch", "falcon");
  RandomStream random(4, "hand_on_tip_test");
  HandOptions options{.explore_s = 0.7};
  const device::ExplorationPath path(kPlane, {}, random);
  const device::SimulatedHand plain(options, path, device_model(name));
  device::SimulatedHand foreseeing = plain;
  foreseeing.precompute();
  std::vector<Vec3> expected;
  for (const device::SimulatedHand& one : {plain, foreseeing, foreseeing}) {
    device::SimulatedHand hand = one;
    Sensed sense;
    hand.set_sense(sense);
    DeviceSample sample;
    for (int i = 0; hand.read(sample) == DeviceStatus::ok; ++i) {
      REQUIRE(hand.write({0.1 * std::sin(0.3 * i), -0.1 * std::cos(0.2 * i), 0.2}) ==
              DeviceStatus::ok);
    }
    REQUIRE(hand.write({}) == DeviceStatus::ok);
    REQUIRE(sense.felt.size() == 2 * 701);
    if (expected.empty()) expected = sense.felt;
    CHECK(sense.felt == expected);
  }
}

TEST_CASE("a simulated hand yields by its tip's velocity less that without forces") {
  class Sensed final : public TipSense {
   public:
    void feel(const Vec3& /*position_mm*/, const Vec3& /*force_n*/,
              const Vec3& acceleration_m_s2) noexcept override {
      velocity_mm_s = velocity_mm_s + acceleration_m_s2;  // of ticks of 1 ms
    }
    Vec3 velocity_mm_s;
  };
  const HandOptions options = grip({1.2, 0.9, 1.1});
  const DeviceModel touch = device_model("touch");
  RandomStream random(3, "hand_on_tip_test");
  const device::ExplorationPath path(kPlane, {}, random);
  device::SimulatedHand hand(options, path, touch);
  Sensed sense;
  hand.set_sense(sense);
  HeldDevice held(options, touch);
  HeldDevice in_the_air(options, touch);
  std::size_t stroke = 0;
  const Vec2 first_mm = path.at(0.0, stroke).position_mm;
  for (HeldDevice* one : {&held, &in_the_air}) {
    one->place({first_mm.x, first_mm.y, options.start_height_mm});
  }
  for (int i = 0; i < 2000; ++i) {
    const double t_s = i * kServoTickS;
    const double u = std::min(t_s / device::SimulatedHand::kPushBuildUpS, 1.0);
    const PathPoint target = path.at(t_s, stroke);
    const double push_n = options.push_n * (u * u * (3.0 - 2.0 * u));
    const Vec3 force_n{0.1 * std::sin(0.3 * i), -0.1 * std::cos(0.2 * i), 0.2};
    held.tick(force_n, target, push_n);
    in_the_air.tick({}, target, push_n);
    REQUIRE(hand.write(force_n) == DeviceStatus::ok);
    const Vec3 air_mm_s = in_the_air.device.true_velocity_mm_s();
    const Vec3 off_mm_s = held.device.true_velocity_mm_s() - Vec3{air_mm_s.x, air_mm_s.y, 0.0};
    REQUIRE(norm(hand.yielding_velocity_mm_s() - off_mm_s) < 1e-9);
    REQUIRE(norm(sense.velocity_mm_s - off_mm_s) < 1e-6);
  }
}

TEST_CASE("a held device's tick neither allocates nor locks") {
  HeldDevice held(grip(), device_model("touch"));
  static_cast<void>(take_realtime_offences());
  {
    const RealtimeRegion region;
    for (int i = 0; i < 100; ++i) held.tick({0.5, 0.1, 0.0}, {{1.0, 1.0}, {50.0, 0.0}}, 0.7);
  }
  CHECK(take_realtime_offences() == RealtimeOffences{});
  CHECK(is_finite(held.device.true_position_mm()));
}

TEST_CASE("a hand whose factors are impossible is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const HandFactors& factors :
       {HandFactors{-1.0, 1.0, 1.0}, HandFactors{1.0, nan, 1.0}, HandFactors{1.0, 1.0, 0.0}}) {
    CHECK_THROWS_AS(HeldDevice(grip(factors), {}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace touchtrial

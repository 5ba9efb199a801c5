// Shaped forces: the bound, causality, and what they do to a tip, against closed forms.
#include "device/compensation/force_shaper.hpp"

#include "device/flat_wall.hpp"
#include "device/model/held_devices.hpp"
#include "device/platform/realtime.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "support/realtime_watch.hpp"

#include <algorithm>
#include <limits>

namespace touchtrial {
namespace {

using device::DeviceModel;
using device::ForceShaper;
using device::HandKind;
using device::HandOptions;

double db(double factor) {
  return 20.0 * std::log10(factor);
}

TEST_CASE("a shaper's gain is 1 at rest and within its bound at every frequency") {
  const double bound_db = GENERATE(0.0, 6.0, 12.0, 30.0);
  for_every_device_in_every_hand([=](const DeviceModel& model, const HandOptions& hand) {
    const ForceShaper shaper(model, hand, bound_db);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      CHECK(shaper.gain(axis, 0.0) == Approx(1.0).epsilon(1e-9));
      for (double hz = 1.0; hz <= 500.0; hz += 3.0) {
        REQUIRE(std::abs(db(shaper.gain(axis, hz))) <= bound_db + 0.3);
      }
    }
  });
}

TEST_CASE("an ideal device needs no shaping") {
  const HandOptions hand = hand_by(GENERATE(HandKind::point_mass, HandKind::stylus_grip));
  ForceShaper shaper(device::device_model("ideal"), hand, 40.0);
  RandomStream random(1, "force_shaper_test");
  for (int i = 0; i < 1000; ++i) {
    const Vec3 force_n = random_vec(random, 1.0);
    REQUIRE(norm(shaper.shaped(force_n) - force_n) < 1e-9);
  }
}

TEST_CASE("mass and low-pass of a rigid device are turned around, by their closed form") {
  DeviceModel model = model_of(0.15);
  model.lowpass_hz = 100.0;
  const ForceShaper shaper(model, {}, 40.0);
  const double hz = GENERATE(10.0, 25.0, 63.0, 160.0, 320.0);
  const std::complex<double> s(0.0, 2.0 * kPi * hz);
  const std::complex<double> hand = 0.1e-3 * s * s + 0.008 * s + 0.2;
  const double wished =
      std::abs((hand + 0.15e-3 * s * s) / hand) * std::hypot(1.0, hz / model.lowpass_hz);
  CHECK(db(shaper.gain(0, hz)) == Approx(db(wished)).margin(0.2));
}

TEST_CASE("a shaper answers a force only after it, and a held force with itself") {
  ForceShaper shaper(device::device_model("touch"), hand_by(HandKind::stylus_grip), 12.0);
  for (int i = 0; i < 100; ++i) REQUIRE(shaper.shaped({}) == Vec3{});
  Vec3 last_n;
  for (int i = 0; i < 1000; ++i) last_n = shaper.shaped({0.5, -0.2, 1.0});
  CHECK(norm(last_n - Vec3{0.5, -0.2, 1.0}) < 1e-9);
  shaper.reset();
  CHECK(shaper.shaped({}) == Vec3{});
}

TEST_CASE("a shaped force is never beyond the device's peak") {
  const DeviceModel model = device::device_model("falcon");
  ForceShaper shaper(model, hand_by(HandKind::stylus_grip), 40.0);
  RandomStream random(2, "force_shaper_test");
  double greatest_n = 0.0;
  for (int i = 0; i < 2000; ++i) {
    greatest_n = std::max(greatest_n, norm(shaper.shaped(random_vec(random, 4.0))));
  }
  CHECK(greatest_n == Approx(model.max_force_n).epsilon(1e-12));
}

TEST_CASE("a shaped wall is under the servo what the wall is, and costs neither heap nor lock") {
  HandOptions options = hand_by(HandKind::stylus_grip);
  options.explore_s = 3.0;
  RandomStream random(4, "force_shaper_test");
  const device::ExplorationPath path({0.2, 500, 500}, {.duration_s = 3.0}, random);
  const DeviceModel model = device::device_model("touch_x");
  device::SimulatedHand hand(options, path, model);
  FlatWall wall;
  device::CompensatedForce shaped(wall, ForceShaper(model, options, 12.0));
  KeptSamples kept;
  const device::ServoReport report = device::run_servo_in_virtual_time(hand, shaped, kept, {});
  CHECK(report.end == device::ServoEnd::hand_stopped);
  double push_n = 0.0;
  for (int i = 2000; i < 3000; ++i) push_n += 0.001 * kept.samples.at(i).force_n.z;
  CHECK(push_n == Approx(options.push_n).margin(0.1));
  ForceShaper shaper(model, options, 12.0);
  static_cast<void>(take_realtime_offences());
  {
    const device::RealtimeRegion region;
    for (int i = 0; i < 100; ++i) static_cast<void>(shaper.shaped({0.5, 0.1, 0.0}));
  }
  CHECK(take_realtime_offences() == RealtimeOffences{});
}

TEST_CASE("a bound that is none is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bound_db : {-1.0, 40.1, nan}) {
    CHECK_THROWS_AS(ForceShaper({}, {}, bound_db), std::invalid_argument);
  }
}

}  // namespace
}  // namespace touchtrial

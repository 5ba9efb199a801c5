#include "device/safety/safety_chain.hpp"

#include "core/random.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

TEST_CASE("a force that is not finite sends zero and latches until it is re-armed") {
  const double bad = GENERATE(std::numeric_limits<double>::quiet_NaN(),
                              -std::numeric_limits<double>::infinity(), 1e300);
  device::SafetyChain safety(norm_limit_alone());
  CHECK(safety.check({bad, 0.0, 0.0}, {}).verdict == device::SafetyVerdict::fault);
  CHECK(safety.check({0.0, 0.0, 1.0}, {}).force_n == Vec3{});
  CHECK(safety.faulted());
  safety.rearm();
  CHECK(safety.check({0.0, 0.0, 1.0}, {}).force_n == Vec3{0.0, 0.0, 1.0});
}

TEST_CASE("a limit that is not a positive number lets no force pass") {
  const double limit_n = GENERATE(0.0, -1.0, std::numeric_limits<double>::quiet_NaN());
  CHECK(device::SafetyChain(norm_limit_alone(limit_n)).check({0.0, 0.1, 0.0}, {}).force_n ==
        Vec3{});
}

/// A faultless device: it rests in a hand, which trembles, and numbers its readings.
class Readings {
 public:
  device::DeviceSample next() {
    ++sample.sequence;
    sample.position_mm.z = sample.sequence % 2 == 0 ? -1.0 : -1.01;
    return sample;
  }
  device::DeviceSample sample{{1.0, 2.0, -1.0}, {}};
};

/// Applies a force until gate and ramp have passed.
/// \return the force that is sent
Vec3 engage(device::SafetyChain& safety, Readings& device, Vec3 force_n) {
  static_cast<void>(safety.check({}, device.next()));
  for (int tick = 0; tick < 200; ++tick) {
    REQUIRE_FALSE(safety.check(force_n, device.next()).verdict == device::SafetyVerdict::fault);
  }
  return safety.sent_n();
}

TEST_CASE("no force passes before the computed one was small, and then it grows from nothing") {
  device::SafetyChain safety({});
  Readings device;
  for (int tick = 0; tick < 50; ++tick) {
    const device::SafeForce held = safety.check({0.0, 0.0, 0.6}, device.next());
    REQUIRE(held.force_n == Vec3{});
    REQUIRE(held.verdict == device::SafetyVerdict::limited);
  }
  CHECK(safety.check({0.0, 0.0, 0.4}, device.next()).force_n == Vec3{});
  for (int tick = 1; tick < 100; ++tick) {
    REQUIRE(safety.check({0.0, 0.0, 2.0}, device.next()).force_n.z == Approx(0.02 * tick));
  }
}

TEST_CASE("a device that is not ready yet gets zero, without a fault and however it jumps") {
  device::SafetyChain safety({});
  Readings device;
  device.sample.ready = false;
  for (int tick = 0; tick < 50; ++tick) {
    device.sample.position_mm.x = tick % 2 == 0 ? -40.0 : 40.0;
    REQUIRE(safety.check({0.0, 0.0, 0.1}, device.next()).force_n == Vec3{});
  }
  device.sample.ready = true;
  CHECK(engage(safety, device, {0.0, 0.0, 1.0}) == Vec3{0.0, 0.0, 1.0});
}

TEST_CASE("while force is on, each of these is a fault: zero at once, latched") {
  device::SafetyChain safety({});
  Readings device;
  REQUIRE(engage(safety, device, {0.0, 0.0, 3.0}) == Vec3{0.0, 0.0, 3.0});
  device::DeviceSample bad = device.next();
  device::SafetyFault fault = device::SafetyFault::none;
  SECTION("losing readiness") {
    bad.ready = false;
    fault = device::SafetyFault::not_ready;
  }
  SECTION("a jump of the position") {
    bad.position_mm.y += 3.0;
    fault = device::SafetyFault::overspeed;
  }
  SECTION("a speed that no hand has") {
    bad.velocity_mm_s.z = -2500.0;
    fault = device::SafetyFault::overspeed;
  }
  SECTION("a velocity that is not a number") {
    bad.velocity_mm_s.z = std::numeric_limits<double>::quiet_NaN();
    fault = device::SafetyFault::not_finite;
  }
  SECTION("a position that is not a number") {
    bad.position_mm.x = std::numeric_limits<double>::infinity();
    fault = device::SafetyFault::not_finite;
  }
  SECTION("a reading that never changes") {
    for (int tick = 0; tick < 10; ++tick) {
      REQUIRE(safety.check({0.0, 0.0, 3.0}, bad).verdict == device::SafetyVerdict::passed);
    }
    fault = device::SafetyFault::stale_sample;
  }
  SECTION("a position that never changes") {
    for (int tick = 0; tick < 300; ++tick) {
      REQUIRE(safety.check({0.0, 0.0, 3.0}, bad).verdict == device::SafetyVerdict::passed);
      ++bad.sequence;
    }
    fault = device::SafetyFault::frozen_encoders;
  }
  SECTION("one that was seen elsewhere") {
    safety.trip(device::SafetyFault::emergency_stop);
    fault = device::SafetyFault::emergency_stop;
  }
  const device::SafeForce safe = safety.check({0.0, 0.0, 3.0}, bad);
  CHECK(safe.force_n == Vec3{});
  CHECK(safe.verdict == device::SafetyVerdict::fault);
  CHECK(safety.fault() == fault);
  safety.trip(device::SafetyFault::device);
  CHECK(safety.fault() == fault);
  CHECK(safety.check({0.0, 0.0, 0.1}, device.next()).force_n == Vec3{});
}

TEST_CASE("after re-arming, gate and ramp start again from where the hand is now") {
  device::SafetyChain safety({});
  Readings device;
  REQUIRE(engage(safety, device, {0.0, 0.0, 3.0}) == Vec3{0.0, 0.0, 3.0});
  safety.trip(device::SafetyFault::emergency_stop);
  REQUIRE(safety.check({0.0, 0.0, 3.0}, device.next()).force_n == Vec3{});
  device.sample.position_mm.x += 100.0;
  safety.rearm();
  CHECK(safety.check({0.0, 0.0, 3.0}, device.next()).force_n == Vec3{});
  CHECK(safety.check({0.0, 0.0, 0.3}, device.next()).force_n == Vec3{});
  CHECK(safety.check({0.0, 0.0, 3.0}, device.next()).force_n.z == Approx(0.03));
  CHECK_FALSE(safety.faulted());
}

TEST_CASE("the force changes by at most the slew limit, also after an overrun") {
  device::SafetyChain safety({.max_slew_n_per_s = 200.0});
  Readings device;
  static_cast<void>(engage(safety, device, {0.0, 0.0, 1.0}));
  CHECK(safety.check({0.0, 0.0, 2.0}, device.next()).force_n.z == Approx(1.2));
  CHECK(safety.check({0.0, 0.0, 2.0}, device.next(), 5).force_n.z == Approx(1.4));
}

TEST_CASE("an overrun counts with the time that it took") {
  device::SafetyChain safety({});
  Readings device;
  static_cast<void>(engage(safety, device, {}));
  device.sample.position_mm.x += 10.0;
  CHECK(safety.check({}, device.next(), 20).verdict == device::SafetyVerdict::passed);
  device.sample.position_mm.x += 10.0;
  CHECK(safety.check({}, device.next()).verdict == device::SafetyVerdict::fault);
}

TEST_CASE("a position that never changes is no fault where the support alone is large") {
  device::SafetyChain safety({.max_support_n = 5.0});
  device::DeviceSample sample;
  for (int tick = 0; tick < 2000; ++tick) {
    ++sample.sequence;
    REQUIRE_FALSE(safety.check({0.0, 0.0, 0.4}, sample, 1, {0.0, 4.0, 0.0}).verdict ==
                  device::SafetyVerdict::fault);
  }
}

TEST_CASE("the gate judges the rendered force, and no support comes before it opens") {
  device::SafetyChain safety({.max_support_n = 1.5});
  Readings device;
  const Vec3 support_n{0.0, 0.0, 1.2};
  for (int tick = 0; tick < 20; ++tick) {
    const device::SafeForce held = safety.check({0.0, 0.0, 0.6}, device.next(), 1, support_n);
    REQUIRE(held.force_n == Vec3{});
  }
  // 1.2 N of support alone would be above the gate's 0.5 N.
  for (int tick = 0; tick < 101; ++tick) {
    const device::SafeForce safe = safety.check({}, device.next(), 1, support_n);
    REQUIRE(safe.verdict == device::SafetyVerdict::passed);
    REQUIRE(safe.force_n.z == Approx(0.012 * tick).margin(1e-12));
    REQUIRE(safe.rendered_n == Vec3{});
  }
  const device::SafeForce both = safety.check({0.4, 0.0, 0.0}, device.next(), 1, support_n);
  CHECK(both.force_n == Vec3{0.4, 0.0, 1.2});
  CHECK(both.rendered_n == Vec3{0.4, 0.0, 0.0});
}

TEST_CASE("norm and slew limits hold for the rendered force alone, and the support has its own") {
  device::SafetyLimits limits = norm_limit_alone(2.5);
  limits.max_support_n = 4.0;
  SECTION("norm: a weight takes nothing from a press and a texture") {
    device::SafetyChain safety(limits);
    const device::SafeForce safe = safety.check({0.05, 0.0, 0.7}, {}, 1, {0.0, 4.0, 0.0});
    CHECK(safe.verdict == device::SafetyVerdict::passed);
    CHECK(safe.force_n == Vec3{0.05, 4.0, 0.7});
    CHECK(safe.rendered_n == Vec3{0.05, 0.0, 0.7});
  }
  SECTION("norm: the rendered force is shortened, the support is not") {
    device::SafetyChain safety(limits);
    const device::SafeForce safe = safety.check({3.0, 0.0, 0.0}, {}, 1, {0.0, 0.0, 4.0});
    CHECK(safe.verdict == device::SafetyVerdict::limited);
    CHECK(safe.force_n == Vec3{2.5, 0.0, 4.0});
    CHECK(safe.rendered_n == Vec3{2.5, 0.0, 0.0});
  }
  SECTION("norm: the support is shortened to its own limit") {
    device::SafetyChain safety(limits);
    const device::SafeForce safe = safety.check({1.0, 0.0, 0.0}, {}, 1, {0.0, 3.0, 9.0});
    CHECK(norm(safe.force_n - safe.rendered_n) == Approx(4.0));
    CHECK(safe.rendered_n == Vec3{1.0, 0.0, 0.0});
  }
  SECTION("norm: a device without one gets none") {
    device::SafetyChain safety(norm_limit_alone(2.5));
    CHECK(safety.check({1.0, 0.0, 0.0}, {}, 1, {0.0, 0.0, 1.0}).force_n == Vec3{1.0, 0.0, 0.0});
  }
  SECTION("slew: beside a support the rendered force is followed by 0.2 N a tick") {
    device::SafetyChain safety({.max_slew_n_per_s = 200.0, .max_support_n = 4.0});
    Readings device;
    static_cast<void>(engage(safety, device, {}));
    for (int tick = 1; tick <= 5; ++tick) {
      const device::SafeForce safe =
          safety.check({0.0, 0.0, 1.0}, device.next(), 1, {0.0, 3.0, 0.0});
      REQUIRE(safe.rendered_n.z == Approx(0.2 * tick));
      REQUIRE(safe.force_n.y == 3.0);
    }
  }
}

TEST_CASE("a support that is not finite is a fault, and a fault takes the support away") {
  device::SafetyChain safety({.max_support_n = 1.0});
  Readings device;
  static_cast<void>(engage(safety, device, {}));
  for (int tick = 0; tick < 20; ++tick) {
    static_cast<void>(safety.check({}, device.next(), 1, {0.0, 0.0, 1.0}));
  }
  REQUIRE(safety.sent_n().z == 1.0);
  const double bad = GENERATE(std::numeric_limits<double>::quiet_NaN(), 1e300);
  CHECK(safety.check({}, device.next(), 1, {bad, 0.0, 0.0}).force_n == Vec3{});
  CHECK(safety.fault() == device::SafetyFault::not_finite);
  CHECK(safety.check({}, device.next(), 1, {0.0, 0.0, 1.0}).force_n == Vec3{});
}

TEST_CASE("unsound limits or an unsound tick let no force pass") {
  device::SafetyLimits limits;
  double tick_s = 0.001;
  SECTION("a slew that is not a number") {
    limits.max_slew_n_per_s = std::numeric_limits<double>::quiet_NaN();
  }
  SECTION("a negative time") {
    limits.stale_s = -1.0;
  }
  SECTION("a tick of no length") {
    tick_s = 0.0;
  }
  SECTION("a tick that is not a number") {
    tick_s = std::numeric_limits<double>::quiet_NaN();
  }
  device::SafetyChain safety(limits, tick_s);
  Readings device;
  for (int tick = 0; tick < 300; ++tick) {
    const device::SafeForce safe = safety.check({0.0, 0.0, 0.2}, device.next());
    REQUIRE(safe.force_n == Vec3{});
    REQUIRE(safe.verdict == device::SafetyVerdict::limited);
  }
}

/// The chain's limits on a force that has passed the gate, link by link.
class LinkByLink {
 public:
  explicit LinkByLink(const device::SafetyLimits& limits)
      : thermal_(limits, 0.001),
        ramp_(limits.ramp_up_s, 0.001),
        slew_(limits.max_slew_n_per_s, 0.001),
        max_support_n_(limits.max_support_n) {
    ramp_.start();
  }

  /// \return of the rendered force
  Vec3 next(Vec3 force_n, Vec3 support_n) {
    thermal_.heat(dot(sent_n_, sent_n_), 1.0);
    const double share = ramp_.next_share();
    const Vec3 carried_n = share * device::limit_norm(support_n, max_support_n_);
    const double limit_n = thermal_.limit_n(norm(carried_n));
    const Vec3 rendered_n = slew_.step_towards(device::limit_norm(share * force_n, limit_n));
    sent_n_ = rendered_n + carried_n;
    return rendered_n;
  }
  [[nodiscard]] Vec3 sent_n() const { return sent_n_; }

 private:
  device::ThermalBudget thermal_;
  device::RampUp ramp_;
  device::SlewLimit slew_;
  double max_support_n_;
  Vec3 sent_n_;
};

TEST_CASE("a chain equals its links in series, for any jumps of the force") {
  device::SafetyLimits limits{
      .continuous_force_n = GENERATE(0.0, 1.5), .thermal_budget_s = 1.0, .max_support_n = 0.1};
  const bool supported = GENERATE(false, true);
  device::SafetyChain safety(limits);
  LinkByLink links(limits);
  Readings device;
  RandomStream random(1, "forces that jump");
  Vec3 force_n;
  int passed = 0;
  int limited = 0;
  for (int tick = 0; tick < 20'000; ++tick) {
    const double step_n = tick % 500 < 10 ? 2.0 : 0.05;
    force_n = 0.95 * force_n + step_n * Vec3{random.normal(), random.normal(), random.normal()};
    if (tick == 0) force_n = {};
    const Vec3 support_n = supported && tick % 3 != 0 ? Vec3{0.0, 0.125, 0.0} : Vec3{};
    const device::SafeForce safe = safety.check(force_n, device.next(), 1, support_n);
    const Vec3 rendered_n = links.next(force_n, support_n);
    REQUIRE(norm(safe.rendered_n - rendered_n) <= 1e-12);
    REQUIRE(norm(safe.force_n - links.sent_n()) <= 1e-12);
    const bool is_whole = safe.rendered_n == force_n;
    REQUIRE((safe.verdict == device::SafetyVerdict::passed) == is_whole);
    (is_whole ? passed : limited) += 1;
  }
  CHECK(passed > 1'000);
  CHECK(limited > 500);
}

}  // namespace
}  // namespace touchtrial

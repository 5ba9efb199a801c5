#include "device/safety/safety_links.hpp"

#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchtrial {
namespace {

TEST_CASE("a force, position or velocity that is absurd or not finite is detected") {
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity(), 1e300);
  CHECK_FALSE(device::is_finite_state(dot({0.0, bad, 0.0}, {0.0, bad, 0.0}), {}));
  CHECK_FALSE(device::is_finite_state(1.0, {.position_mm = {0.0, 0.0, bad}, .velocity_mm_s = {}}));
  CHECK_FALSE(device::is_finite_state(1.0, {.position_mm = {}, .velocity_mm_s = {bad, 0.0, 0.0}}));
}

TEST_CASE("numbers of any sensible size are finite") {
  CHECK(device::is_finite_state(
      1e6, {.position_mm = {-1e6, 0.0, 1e6}, .velocity_mm_s = {1e9, 0.0, 0.0}}));
}

TEST_CASE("a gate opens at the first small force, and stays open") {
  device::EngageGate gate(0.5);
  CHECK_FALSE(gate.try_open(0.26));
  CHECK_FALSE(gate.is_open());
  CHECK(gate.try_open(0.25));
  CHECK(gate.try_open(9.0));
}

TEST_CASE("a closed gate has to be opened again") {
  device::EngageGate gate(0.5);
  REQUIRE(gate.try_open(0.0));
  gate.close();
  CHECK_FALSE(gate.try_open(1.0));
}

TEST_CASE("a gate without a limit opens at once, one that is not a number never") {
  CHECK(device::EngageGate(std::numeric_limits<double>::infinity()).try_open(1e9));
  CHECK_FALSE(device::EngageGate(std::numeric_limits<double>::quiet_NaN()).try_open(0.0));
}

device::DeviceSample at(double x_mm, std::uint64_t sequence, double reported_mm_s = 0.0) {
  return {{x_mm, 0.0, 0.0}, {reported_mm_s, 0.0, 0.0}, sequence};
}

TEST_CASE("a reported speed beyond the limit trips") {
  device::VelocityTrip trip(2000.0, 0.001);
  trip.start(at(0.0, 1));
  CHECK_FALSE(trip.is_exceeded(at(0.0, 2, 1999.0), 1.0));
  CHECK(trip.is_exceeded(at(0.0, 3, -2001.0), 1.0));
}

TEST_CASE("a jump between two readings trips") {
  device::VelocityTrip trip(2000.0, 0.001);
  trip.start(at(0.0, 1));
  CHECK_FALSE(trip.is_exceeded(at(1.9, 2), 1.0));
  CHECK(trip.is_exceeded(at(4.0, 3), 1.0));
}

TEST_CASE("a steady speed is judged alike at every rate of servo and device") {
  const double servo_hz = GENERATE(1000.0, 4000.0, 10'000.0);
  const double device_hz = GENERATE(500.0, 1000.0, 10'000.0);
  const double speed_mm_s = GENERATE(1900.0, 2300.0);
  device::VelocityTrip trip(2000.0, 1.0 / servo_hz);
  trip.start(at(0.0, 0));
  bool tripped = false;
  for (int tick = 1; tick < 1000; ++tick) {
    const auto reading = static_cast<std::uint64_t>(tick * device_hz / servo_hz);
    const double x_mm = speed_mm_s * static_cast<double>(reading) / device_hz;
    tripped = tripped || trip.is_exceeded(at(x_mm, reading), 1.0);
  }
  CHECK(tripped == (speed_mm_s > 2000.0));
}

TEST_CASE("readings that arrive together are no jump") {
  device::VelocityTrip trip(2000.0, 0.0001);
  trip.start(at(0.0, 1));
  // 500 mm/s at 1 kHz, but the second reading comes one servo tick after the first.
  for (int tick = 1; tick < 19; ++tick) REQUIRE_FALSE(trip.is_exceeded(at(0.0, 1), 1.0));
  CHECK_FALSE(trip.is_exceeded(at(0.5, 2), 1.0));
  CHECK_FALSE(trip.is_exceeded(at(1.0, 3), 1.0));
}

TEST_CASE("after a pause of the device, or of the servo, the whole pause counts") {
  const double ticks_a_look = GENERATE(1.0, 9.0);
  device::VelocityTrip trip(2000.0, 0.001);
  trip.start(at(0.0, 1));
  for (double tick = ticks_a_look; tick < 9.0; tick += ticks_a_look) {
    REQUIRE_FALSE(trip.is_exceeded(at(0.0, 1), ticks_a_look));
  }
  CHECK_FALSE(trip.is_exceeded(at(9.0, 2), ticks_a_look));
  CHECK(trip.is_exceeded(at(12.0, 3), 1.0));
}

TEST_CASE("a jump under a number that repeats trips too") {
  device::VelocityTrip trip(2000.0, 0.001);
  trip.start(at(0.0, 1));
  CHECK(trip.is_exceeded(at(5.0, 1), 1.0));
}

TEST_CASE("without a limit no motion trips") {
  device::VelocityTrip trip(std::numeric_limits<double>::infinity(), 0.001);
  trip.start(at(0.0, 1));
  CHECK_FALSE(trip.is_exceeded(at(1e6, 2, 1e9), 1.0));
}

/// Looks at one reading until it is called stale.
/// \return the number of looks
int looks_until_stale(device::Freshness& freshness, double ticks_a_look) {
  freshness.start(7);
  int looks = 1;
  while (!freshness.is_stale(7, ticks_a_look)) {
    REQUIRE(looks < 1000);
    ++looks;
  }
  return looks;
}

TEST_CASE("a reading that repeats for the allowed time is stale, at any rate") {
  const double rate_hz = GENERATE(1000.0, 4000.0, 10'000.0);
  device::Freshness freshness(0.010, 1.0 / rate_hz);
  CHECK(looks_until_stale(freshness, 1.0) == static_cast<int>(0.010 * rate_hz));
}

TEST_CASE("a device at 1 kHz under a servo at 4 kHz is fresh") {
  device::Freshness freshness(0.010, 1.0 / 4000.0);
  freshness.start(1);
  for (std::uint64_t tick = 0; tick < 4000; ++tick) {
    REQUIRE_FALSE(freshness.is_stale(1 + tick / 4, 1.0));
  }
}

TEST_CASE("a servo that slept looks twice before it calls the device stale") {
  device::Freshness freshness(0.010, 0.001);
  CHECK(looks_until_stale(freshness, 46.0) == 2);
  freshness.start(1);
  CHECK_FALSE(freshness.is_stale(1, 46.0));
  CHECK_FALSE(freshness.is_stale(2, 1.0));
  CHECK_FALSE(freshness.is_stale(2, 46.0));
}

TEST_CASE("late looks count for the time that passed") {
  device::Freshness freshness(0.010, 0.001);
  CHECK(looks_until_stale(freshness, 2.0) == 5);
}

TEST_CASE("with no limit nothing is ever stale") {
  device::Freshness freshness(std::numeric_limits<double>::infinity(), 0.001);
  freshness.start(1);
  for (int look = 0; look < 1000; ++look) REQUIRE_FALSE(freshness.is_stale(1, 1000.0));
}

constexpr double kTickS = 0.001;
constexpr device::SafetyLimits kOmni{
    .max_force_n = 3.3, .continuous_force_n = 0.88, .thermal_budget_s = 20.0};

/// Sends as much of a force as the budget allows.
/// \return the force of the last tick
double push(device::ThermalBudget& budget, double force_n, double time_s) {
  double sent_n = 0.0;
  double hottest_n2 = 0.0;
  for (int tick = 0; tick < std::lround(time_s / kTickS); ++tick) {
    sent_n = std::min(force_n, budget.limit_n());
    budget.heat(sent_n * sent_n, 1.0);
    hottest_n2 = std::max(hottest_n2, budget.heat_n2());
  }
  REQUIRE(hottest_n2 <= 0.88 * 0.88);
  return sent_n;
}

TEST_CASE("a cold motor gives its peak force for the time of the budget, then less") {
  device::ThermalBudget budget(kOmni, kTickS);
  CHECK(push(budget, 3.3, 19.9) == 3.3);
  CHECK(push(budget, 3.3, 0.2) < 3.3);
}

TEST_CASE("in the long run a motor gives no more than its continuous force, and never less") {
  device::ThermalBudget budget(kOmni, kTickS);
  const double at_last_n = push(budget, 3.3, 2000.0);
  CHECK(at_last_n == Approx(0.88).epsilon(0.02));
  CHECK(at_last_n >= 0.88);
}

TEST_CASE("the force with which a hand presses on a texture is never limited") {
  device::ThermalBudget budget(kOmni, kTickS);
  CHECK(push(budget, 0.7, 3600.0) == 0.7);
  CHECK(budget.limit_n() == 3.3);
}

TEST_CASE("the limit falls without a step") {
  device::ThermalBudget budget(kOmni, kTickS);
  double last_n = 3.3;
  double largest_step_n = 0.0;
  for (int tick = 0; tick < 100'000; ++tick) {
    budget.heat(last_n * last_n, 1.0);
    largest_step_n = std::max(largest_step_n, std::abs(budget.limit_n() - last_n));
    last_n = budget.limit_n();
  }
  CHECK(largest_step_n < 0.002);
  CHECK(last_n < 1.0);
}

TEST_CASE("a motor that worked before a run begins warm, and less so the longer it rested") {
  device::ThermalBudget earlier(kOmni, kTickS);
  push(earlier, 3.3, 15.0);
  device::ThermalBudget at_once(kOmni, kTickS);
  at_once.begin_warm(earlier.heat_n2(), 0.0);
  CHECK(at_once.heat_n2() == earlier.heat_n2());
  CHECK(push(at_once, 3.3, 10.0) < 3.3);
  device::ThermalBudget rested(kOmni, kTickS);
  rested.begin_warm(earlier.heat_n2(), 3600.0);
  CHECK(push(rested, 3.3, 19.0) == 3.3);
  device::ThermalBudget no_clock(kOmni, kTickS);
  no_clock.begin_warm(earlier.heat_n2(), -5.0);
  CHECK(no_clock.heat_n2() == earlier.heat_n2());
}

TEST_CASE("heat that is not a number, and a device without a budget, begin cold") {
  device::ThermalBudget budget(kOmni, kTickS);
  budget.begin_warm(std::nan(""), 0.0);
  CHECK(budget.heat_n2() == 0.0);
  device::ThermalBudget none({.max_force_n = 3.3}, kTickS);
  none.begin_warm(5.0, 0.0);
  CHECK(none.limit_n() == 3.3);
}

TEST_CASE("a motor that rests gets its peak force back") {
  device::ThermalBudget budget(kOmni, kTickS);
  static_cast<void>(push(budget, 3.3, 60.0));
  REQUIRE(budget.limit_n() < 3.0);
  static_cast<void>(push(budget, 0.0, 60.0));
  CHECK(budget.limit_n() == 3.3);
}

TEST_CASE("late ticks warm a motor for as long as they lasted") {
  device::ThermalBudget every(kOmni, kTickS);
  device::ThermalBudget late(kOmni, kTickS);
  for (int tick = 0; tick < 10'000; ++tick) every.heat(4.0, 1.0);
  for (int tick = 0; tick < 1000; ++tick) late.heat(4.0, 10.0);
  CHECK(late.heat_n2() == Approx(every.heat_n2()).epsilon(1e-3));
  late.heat(4.0, 1e12);
  CHECK(late.heat_n2() == Approx(4.0));
}

TEST_CASE("without a continuous force, or with one above the peak, there is no budget") {
  device::SafetyLimits limits = kOmni;
  limits.continuous_force_n = GENERATE(0.0, 3.3, 8.0);
  device::ThermalBudget budget(limits, kTickS);
  CHECK(push(budget, 3.3, 300.0) == 3.3);
  CHECK(budget.heat_n2() == 0.0);
}

TEST_CASE(
    "a carried force reduces the limit the more, the warmer the motors are, and not at all when "
    "cold") {
  device::ThermalBudget budget(3.0, 1.0, 1.0, 0.001);
  CHECK(budget.limit_n(0.4) == 3.0);
  budget.heat(9.0, 1e9);
  CHECK(budget.limit_n(0.4) == Approx(0.6));
  CHECK(budget.limit_n(1.5) == 0.0);
}

/// \return at which look a position that never changes is frozen, counted from 1; 0: not within
///   10,000
int frozen_at(device::FrozenEncoders encoders, double pressed_n) {
  encoders.start({1.0, 2.0, -1.0});
  for (int look = 1; look <= 10'000; ++look) {
    if (encoders.is_frozen({1.0, 2.0, -1.0}, pressed_n * pressed_n)) return look;
  }
  return 0;
}

TEST_CASE("encoders that stand still under a newton for the allowed time are frozen, at any rate") {
  CHECK(frozen_at({0.3, 0.001}, 1.0) == 300);
  CHECK(frozen_at({0.3, 0.0001}, 2.0) == 3000);
  CHECK(frozen_at({std::numeric_limits<double>::infinity(), 0.001}, 2.0) == 0);
}

TEST_CASE("a hand that bears less than a newton may stand still") {
  CHECK(frozen_at({0.3, 0.001}, 0.99) == 0);
  CHECK(frozen_at({0.3, 0.001}, std::numeric_limits<double>::quiet_NaN()) == 0);
}

TEST_CASE("the least motion of one coordinate, or a moment without force, restarts the count") {
  device::FrozenEncoders encoders(0.01, 0.001);
  Vec3 position_mm{1.0, 2.0, -1.0};
  const double pressed_n2 = 4.0;
  encoders.start(position_mm);
  for (int look = 0; look < 9; ++look) REQUIRE_FALSE(encoders.is_frozen(position_mm, pressed_n2));
  SECTION("motion") {
    position_mm.y = std::nextafter(2.0, 3.0);
    REQUIRE_FALSE(encoders.is_frozen(position_mm, pressed_n2));
  }
  SECTION("no force") {
    REQUIRE_FALSE(encoders.is_frozen(position_mm, 0.0));
  }
  SECTION("a new run") {
    encoders.start(position_mm);
  }
  for (int look = 0; look < 9; ++look) REQUIRE_FALSE(encoders.is_frozen(position_mm, pressed_n2));
  CHECK(encoders.is_frozen(position_mm, pressed_n2));
}

TEST_CASE("forces grow evenly from nothing to their full size") {
  device::RampUp ramp(0.1, 0.001);
  ramp.start();
  for (int tick = 0; tick < 100; ++tick) {
    REQUIRE(ramp.next_share() == Approx(tick / 100.0).margin(1e-12));
  }
  CHECK(ramp.next_share() == Approx(1.0));
  CHECK(ramp.next_share() == 1.0);
}

TEST_CASE("a ramp of no length lets the first force pass whole") {
  device::RampUp ramp(0.0, 0.001);
  ramp.start();
  CHECK(ramp.next_share() == 1.0);
}

TEST_CASE("a restarted ramp begins at zero") {
  device::RampUp ramp(0.002, 0.001);
  ramp.start();
  for (int tick = 0; tick < 5; ++tick) static_cast<void>(ramp.next_share());
  ramp.start();
  CHECK(ramp.next_share() == 0.0);
}

TEST_CASE("a force within its norm is untouched, one past it keeps its direction") {
  CHECK(device::limit_norm({0.3, -0.4, 0.0}, 0.5) == Vec3{0.3, -0.4, 0.0});
  CHECK(device::limit_norm({3.0, 0.0, -4.0}, 2.5) == Vec3{1.5, 0.0, -2.0});
}

TEST_CASE("a force moves one step per tick, straight towards its target") {
  device::SlewLimit slew(1000.0, 0.001);
  CHECK(slew.step_towards({3.0, 4.0, 0.0}).x == Approx(0.6));
  CHECK(slew.step_towards({3.0, 4.0, 0.0}).y == Approx(1.6));
  for (int tick = 0; tick < 2; ++tick) static_cast<void>(slew.step_towards({3.0, 4.0, 0.0}));
  CHECK(norm(slew.sent_n()) == Approx(4.0));
  CHECK(slew.step_towards({3.0, 4.0, 0.0}) == Vec3{3.0, 4.0, 0.0});
}

TEST_CASE("a small change passes to the last bit") {
  device::SlewLimit slew(1000.0, 0.001);
  CHECK(slew.step_towards({0.1, 0.2, 0.3}) == Vec3{0.1, 0.2, 0.3});
  CHECK(slew.step_towards({0.3, 0.1, 0.7}) == Vec3{0.3, 0.1, 0.7});
}

TEST_CASE("a fault drops the force at once, without a slope") {
  device::SlewLimit slew(1000.0, 0.001);
  for (int tick = 0; tick < 5; ++tick) static_cast<void>(slew.step_towards({0.0, 0.0, 3.0}));
  slew.drop();
  CHECK(slew.sent_n() == Vec3{});
  CHECK(slew.step_towards({0.0, 0.0, 3.0}).z == Approx(1.0));
}

TEST_CASE("without a limit every force passes") {
  device::SlewLimit slew(std::numeric_limits<double>::infinity(), 0.001);
  CHECK(slew.step_towards({0.0, -50.0, 0.0}) == Vec3{0.0, -50.0, 0.0});
}

}  // namespace

}  // namespace touchtrial

#include "device/safety/velocity_trip.hpp"

#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

device::DeviceSample at(double x_mm, std::uint64_t sequence, double reported_mm_s = 0.0) {
  return {{x_mm, 0.0, 0.0}, {reported_mm_s, 0.0, 0.0}, sequence};
}

TEST_CASE("a reported speed past the limit trips") {
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

}  // namespace
}  // namespace touchtrial

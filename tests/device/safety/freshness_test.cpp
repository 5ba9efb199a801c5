#include "device/safety/freshness.hpp"

#include "support/catch.hpp"

#include <limits>

namespace touchtrial {
namespace {

/// Looks at one and the same reading until it is called stale. \return number of looks
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

}  // namespace
}  // namespace touchtrial

#include "device/drivers/falcon/falcon_motors.hpp"

#include "core/random.hpp"
#include "device/drivers/falcon/emulator/falcon_legs.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace touchtrial::device::falcon {
namespace {

using std::chrono::milliseconds;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

FalconSettings with_values(int peak, int continuous) {
  return {.motor_peak = peak, .motor_continuous = continuous};
}

/// \return what cold motors are sent
MotorCommand cold(const PerLeg& torques_nm, const FalconSettings& settings = {}) {
  return FalconMotors(settings).command(torques_nm, {});
}

TEST_CASE("falcon motors: minus 6,616 for a newton metre, rounded") {
  CHECK(cold({0.125, -0.25, 0.0}).values == MotorValues{-827, 1654, 0});
  CHECK(cold({0.00007, 0.00008, -0.00008}).values == MotorValues{0, -1, 1});
  CHECK_FALSE(cold({0.6189, -0.6189, 0.0}).limited);
}

TEST_CASE("falcon motors: beyond 4,095 all three are scaled by one factor, which is reported") {
  CHECK(cold({-1.0, 0.0, 0.0}).values == MotorValues{4095, 0, 0});
  CHECK(cold({-2.0, 1.2, 0.4}).values == MotorValues{4095, -2457, -819});
  CHECK(cold({-1.0, 0.0, 0.0}).limited);
  RandomStream random(2, "falcon clamp");
  for (int i = 0; i < 2000; ++i) {
    const PerLeg torques = {random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0),
                            random.uniform(-50.0, 50.0)};
    const MotorValues values = cold(torques).values;
    const double most =
        std::max({std::abs(torques[0]), std::abs(torques[1]), std::abs(torques[2])});
    const double scale = std::min(1.0, 4095.0 / 6616.0 / most);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      REQUIRE(std::abs(values[axis]) <= 4095);
      REQUIRE(std::abs(values[axis] + 6616.0 * scale * torques[axis]) <= 0.5 + 1e-6);
    }
  }
}

TEST_CASE("falcon motors: a lab that measured its motors sets their greatest value") {
  CHECK(cold({-2.0, 1.0, 0.0}, with_values(8000, 1365)).values == MotorValues{8000, -4000, 0});
}

TEST_CASE("falcon motors: torques that are not finite or too large give zero or values in range") {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    CHECK(cold({bad, 0.1, 0.1}).values == MotorValues{});
    CHECK(cold({0.1, 0.1, bad}).values == MotorValues{});
  }
  CHECK(cold({1e300, 0.0, 0.0}).values == MotorValues{-4095, 0, 0});
  CHECK(cold({1e308, 0.0, 0.0}).values == MotorValues{});
}

TEST_CASE("falcon motors: the force of a value is the least in the ball of 40 mm, by its legs") {
  RandomStream random(3, "falcon greatest force");
  const auto direction = [&] {
    const Vec3 any = {random.normal(), random.normal(), random.normal()};
    return (1.0 / norm(any)) * any;
  };
  double min_n = kInfinity;
  for (int i = 0; i < 4000; ++i) {
    const double radius_mm = 40.0 * std::cbrt(i % 4 == 0 ? random.uniform() : 1.0);
    const Vec3 place_m = to_native_m(radius_mm * direction());
    const Vec3 force = direction();
    // The motors' values for 1 N: the rows turn torques into force, so this solves for them.
    const std::array<Vec3, 3> rows = reference_rows(place_m).value();
    const auto triple = [](Vec3 a, Vec3 b, Vec3 c) {
      return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
             a.z * (b.x * c.y - b.y * c.x);
    };
    const double all = triple(rows[0], rows[1], rows[2]);
    const double most = std::max({std::abs(triple(force, rows[1], rows[2])),
                                  std::abs(triple(rows[0], force, rows[2])),
                                  std::abs(triple(rows[0], rows[1], force))}) /
                        std::abs(all);
    min_n = std::min(min_n, 1.0 / 6616.0 / most);
  }
  CHECK(min_n >= kForcePerMotorValueN);
  CHECK(min_n < 1.1 * kForcePerMotorValueN);
}

/// \return the fading mean of the squares of what one motor got, a value each millisecond
double heat_of(const std::vector<double>& values, double tau_s) {
  double heat = 0.0;
  for (const double value : values) heat += 1e-3 / tau_s * (value * value - heat);
  return heat;
}

TEST_CASE("falcon motors: one that bears all is limited by its own heat, with the direction kept") {
  FalconMotors motors({});
  std::vector<double> first, second;
  int free_ms = 0;
  for (int ms = 0; ms < 600'000; ++ms) {
    const MotorCommand command =
        motors.command({-4000.0 / 6616.0, 2000.0 / 6616.0, 0.0}, milliseconds(ms));
    first.push_back(command.values[0]);
    second.push_back(command.values[1]);
    if (!command.limited && free_ms == ms) ++free_ms;
    REQUIRE(std::abs(command.values[1] + 0.5 * command.values[0]) <= 1.0);
  }
  // Physics: heat goes with the square and fades; a cold motor at 4,095 reaches 90 % of what it
  // holds for ever in 20 s, so at 4,000 it takes a little longer.
  const double tau_s = -20.0 / std::log(1.0 - 0.9 * (1365.0 / 4095.0) * (1365.0 / 4095.0));
  CHECK(free_ms > 20'000);
  CHECK(free_ms < 22'000);
  CHECK(heat_of(first, tau_s) <= 1365.0 * 1365.0 * 1.002);
  CHECK(first.back() == Approx(1365.0).epsilon(0.02));
  CHECK(heat_of(second, tau_s) < 0.26 * 1365.0 * 1365.0);
}

TEST_CASE("falcon motors: a hand that presses with 0.7 N for an hour never meets their budget") {
  // The least favourable place and direction.
  const double torque_nm = 0.7 / 6616.0 / kForcePerMotorValueN;
  FalconMotors motors({});
  for (int ms = 0; ms < 3'600'000; ms += 10) {
    REQUIRE_FALSE(motors.command({torque_nm, 0.0, 0.0}, milliseconds(ms)).limited);
  }
}

TEST_CASE("falcon motors: heat is that of the sent command, over the time until the next one") {
  FalconMotors often({});
  FalconMotors seldom({});
  for (int ms = 0; ms < 15'000; ++ms) {
    static_cast<void>(often.command({0.6, 0.0, 0.0}, milliseconds(ms)));
    if (ms % 3 == 0) static_cast<void>(seldom.command({0.6, 0.0, 0.0}, milliseconds(ms)));
  }
  const auto left_ms = [](FalconMotors& motors) {
    int ms = 15'000;
    while (!motors.command({0.6, 0.0, 0.0}, milliseconds(ms)).limited) ++ms;
    return ms;
  };
  const int after_often = left_ms(often);
  CHECK(std::abs(left_ms(seldom) - after_often) < 30);
  // A long rest cools them.
  FalconMotors rested({});
  for (int ms = 0; ms < 15'000; ++ms) {
    static_cast<void>(rested.command({0.6, 0.0, 0.0}, milliseconds(ms)));
  }
  static_cast<void>(rested.command({}, milliseconds(15'000)));
  int ms = 3'600'000;
  while (!rested.command({0.6, 0.0, 0.0}, milliseconds(ms)).limited) ++ms;
  CHECK(ms > 3'619'000);
}

TEST_CASE("falcon motors: a continuous value that is not below the peak is no budget") {
  FalconMotors motors(with_values(4095, 4095));
  for (int ms = 0; ms < 100'000; ms += 10) {
    REQUIRE_FALSE(motors.command({0.6, 0.0, 0.0}, milliseconds(ms)).limited);
  }
}

}  // namespace
}  // namespace touchtrial::device::falcon

#include "device/servo/velocity_estimate.hpp"

#include "support/catch.hpp"

#include <cmath>

namespace touchtrial {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using Estimate = device::VelocityEstimate<5>;

TEST_CASE("one reading gives no velocity") {
  Estimate estimate;
  CHECK(estimate.add({5.0, 6.0, 7.0}, milliseconds(3)) == Vec3{});
}

TEST_CASE("steady motion is found exactly, however unevenly its readings come") {
  Estimate estimate;
  const Vec3 velocity_mm_s = {100.0, -50.0, 20.0};
  Vec3 found;
  for (const int us : {0, 900, 2100, 2950, 4400, 5000, 6300}) {
    found = estimate.add(1e-6 * us * velocity_mm_s, microseconds(us));
  }
  CHECK(found.x == Approx(100.0).epsilon(1e-9));
  CHECK(found.y == Approx(-50.0).epsilon(1e-9));
  CHECK(found.z == Approx(20.0).epsilon(1e-9));
}

TEST_CASE("under acceleration the estimate is the velocity of two readings ago") {
  Estimate estimate;
  double found = 0.0;
  for (int ms = 0; ms < 20; ++ms) {
    found = estimate.add({0.5 * 1000.0 * 1e-6 * ms * ms, 0.0, 0.0}, milliseconds(ms)).x;
  }
  CHECK(found == Approx(1000.0 * 0.017).epsilon(1e-9));
}

TEST_CASE("one encoder count of 0.04 mm back and forth stays below 12 mm per second") {
  Estimate estimate;
  double most = 0.0;
  for (int ms = 0; ms < 100; ++ms) {
    const Vec3 found = estimate.add({0.04 * (ms / 2 % 2), 0.0, 0.0}, milliseconds(ms));
    if (ms > 5) most = std::max(most, std::abs(found.x));
  }
  CHECK(most > 0.0);
  CHECK(most < 12.0);
}

TEST_CASE("the line's lag is half of its time, and its noise that of the formula") {
  device::VelocityEstimate<9> estimate;
  const double seconds = 250e-6;
  double found = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double t = seconds * i;
    found = estimate.add({0.5 * 1000.0 * t * t, 0.0, 0.0}, microseconds(250 * i)).x;
  }
  CHECK(found == Approx(1000.0 * seconds * (39 - 4)).epsilon(1e-9));
  // One reading off by 1 mm, in each place of the line: the squares of its effects add up to those
  // of readings that are off by themselves.
  double squares = 0.0;
  for (int place = 0; place < 9; ++place) {
    estimate.reset();
    for (int i = 0; i < 9; ++i) {
      found = estimate.add({i == place ? 1.0 : 0.0, 0.0, 0.0}, microseconds(250 * i)).x;
    }
    squares += found * found;
  }
  CHECK(std::sqrt(squares) == Approx(std::sqrt(12.0 / (9.0 * 9.0 * 9.0 - 9.0)) / seconds));
}

TEST_CASE("readings from before a long pause are forgotten") {
  Estimate estimate;
  static_cast<void>(estimate.add({0.0, 0.0, 0.0}, milliseconds(0)));
  static_cast<void>(estimate.add({1.0, 0.0, 0.0}, milliseconds(1)));
  CHECK(estimate.add({1.0, 0.0, 0.0}, milliseconds(100)) == Vec3{});
  CHECK(estimate.add({2.0, 0.0, 0.0}, milliseconds(101)).x == Approx(1000.0));
}

TEST_CASE("readings at one moment have zero velocity, rather than an infinite one") {
  Estimate estimate;
  static_cast<void>(estimate.add({0.0, 0.0, 0.0}, milliseconds(1)));
  CHECK(estimate.add({1.0, 0.0, 0.0}, milliseconds(1)) == Vec3{});
}

}  // namespace
}  // namespace touchtrial

#include "device/safety/safety_limits.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <limits>

namespace touchtrial {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

device::DeviceInfo device_of(double max_force_n, double continuous_force_n) {
  return {.max_force_n = max_force_n, .continuous_force_n = continuous_force_n};
}

TEST_CASE("the default limits are sound") {
  CHECK(device::are_valid({}));
}

TEST_CASE("a limit out of its range is unsound, whichever it is") {
  double device::SafetyLimits::*limit =
      GENERATE(&device::SafetyLimits::max_force_n, &device::SafetyLimits::continuous_force_n,
               &device::SafetyLimits::thermal_budget_s, &device::SafetyLimits::max_slew_n_per_s,
               &device::SafetyLimits::max_speed_mm_s, &device::SafetyLimits::engage_force_n,
               &device::SafetyLimits::ramp_up_s, &device::SafetyLimits::stale_s,
               &device::SafetyLimits::frozen_s, &device::SafetyLimits::max_support_n);
  const double value = GENERATE(-1.0, kNaN, -kInfinity);
  device::SafetyLimits limits;
  limits.*limit = value;
  CHECK_FALSE(device::are_valid(limits));
}

TEST_CASE("force and ramp must be finite, the limits that switch a link off need not") {
  CHECK_FALSE(device::are_valid({.max_force_n = kInfinity, .max_slew_n_per_s = kInfinity}));
  CHECK_FALSE(device::are_valid({.ramp_up_s = kInfinity}));
  CHECK_FALSE(device::are_valid({.max_support_n = kInfinity}));
  CHECK(device::are_valid({.max_slew_n_per_s = kInfinity,
                           .max_speed_mm_s = kInfinity,
                           .engage_force_n = kInfinity,
                           .stale_s = kInfinity,
                           .frozen_s = kInfinity}));
}

TEST_CASE("a slew limit that cannot let go in time is unsound") {
  CHECK(device::are_valid({.max_force_n = 3.3, .max_slew_n_per_s = 66.1}));
  CHECK_FALSE(device::are_valid({.max_force_n = 3.3, .max_slew_n_per_s = 65.9}));
}

TEST_CASE("on a device the smaller limits hold") {
  device::SafetyLimits limits = device::limits_on(device_of(8.0, 0.0), {.max_force_n = 3.3});
  CHECK(limits.max_force_n == 3.3);
  CHECK(limits.continuous_force_n == 0.0);
  limits = device::limits_on(device_of(2.0, 0.88), {.max_force_n = 3.3});
  CHECK(limits.max_force_n == 2.0);
  CHECK(limits.continuous_force_n == 0.88);
  CHECK(device::limits_on(device_of(8.0, 0.88), {.continuous_force_n = 0.5}).continuous_force_n ==
        0.5);
  CHECK(device::limits_on(device_of(8.0, 0.0), {.continuous_force_n = 0.5}).continuous_force_n ==
        0.5);
}

TEST_CASE("encoders that freeze are looked for on devices that have them, and there alone") {
  device::DeviceInfo info = device_of(3.3, 0.0);
  CHECK(device::limits_on(info, {}).frozen_s == kInfinity);
  CHECK(std::isnan(device::limits_on(info, {.frozen_s = kNaN}).frozen_s));
  info.has_encoders = true;
  CHECK(device::limits_on(info, {}).frozen_s == 0.3);
  CHECK(device::limits_on(info, {.frozen_s = kInfinity}).frozen_s == kInfinity);
}

TEST_CASE("the limit of a support is the device's") {
  device::DeviceInfo info = device_of(3.3, 0.0);
  CHECK(device::limits_on(info, {.max_support_n = 2.0}).max_support_n == 0.0);
  info.max_support_n = 1.0;
  CHECK(device::limits_on(info, {}).max_support_n == 1.0);
}

TEST_CASE("a device without a known force limit gets no force") {
  CHECK_FALSE(device::are_valid(device::limits_on(device_of(kNaN, 0.0), {})));
  CHECK_FALSE(device::are_valid(device::limits_on(device_of(3.3, kNaN), {})));
  CHECK_FALSE(device::are_valid(device::limits_on(device_of(0.0, 0.0), {})));
}

}  // namespace
}  // namespace touchtrial

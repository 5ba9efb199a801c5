#include "device/safety/safety_limits.hpp"

#include <cmath>

namespace touchtrial::device {
namespace {

/// Unlike std::min, NaN if either is.
double smaller(double a, double b) noexcept {
  if (std::isnan(a) || std::isnan(b)) return a + b;
  return a < b ? a : b;
}

}  // namespace

bool is_sound(const SafetyLimits& limits) noexcept {
  const bool force = limits.max_force_n > 0.0 && std::isfinite(limits.max_force_n) &&
                     limits.max_slew_n_per_s >= limits.max_force_n / kLongestLetGoS;
  const bool heat = limits.continuous_force_n >= 0.0 && limits.thermal_budget_s > 0.0;
  const bool engaging =
      limits.engage_force_n >= 0.0 && limits.ramp_up_s >= 0.0 && std::isfinite(limits.ramp_up_s);
  return force && heat && engaging && limits.max_speed_mm_s > 0.0 && limits.stale_s > 0.0;
}

SafetyLimits limits_on(const DeviceInfo& device, SafetyLimits limits) noexcept {
  limits.max_force_n = smaller(limits.max_force_n, device.max_force_n);
  if (limits.continuous_force_n == 0.0) {
    limits.continuous_force_n = device.continuous_force_n;
  } else if (device.continuous_force_n != 0.0) {
    limits.continuous_force_n = smaller(limits.continuous_force_n, device.continuous_force_n);
  }
  return limits;
}

}  // namespace touchtrial::device

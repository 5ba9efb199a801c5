/// \file The limits of the safety chain and their valid ranges.
#pragma once

#include "device/haptic_device.hpp"

#include <cmath>
#include <limits>

namespace touchtrial::device {

/// Every force must be able to fall to zero within this time: SafetyLimits whose slew limit takes
/// longer from max_force_n to zero are invalid.
inline constexpr double kMaxReleaseS = 0.05;

/// Limits that apply to every device. The defaults suit a hand that strokes a texture: in ordinary
/// use only the norm limit takes effect. Infinity disables a link whose limit may be infinite. With
/// invalid limits no force passes.
struct SafetyLimits {
  double max_force_n = 3.3;          ///< of the force's norm, > 0, finite
  double continuous_force_n = 0.0;   ///< sustainable without time limit; 0: no thermal budget
  double thermal_budget_s = 20.0;    ///< at peak force, from cold, before the limit falls; > 0
  double max_slew_n_per_s = 1000.0;  ///< of the force's change, >= max_force_n / kMaxReleaseS
  double max_speed_mm_s = 2000.0;    ///< reported or from positions; a higher speed is a fault
  double engage_force_n = 0.5;       ///< forces pass only after a computed force below this
  double ramp_up_s = 0.1;            ///< from engaging to full force, >= 0, finite
  double stale_s = 0.010;            ///< a fault after this time without a new reading; > 0
  /// A fault after this time at exactly the same position under at least FrozenEncoders::kPressedN;
  /// > 0. Infinity if a weight may hang on the handle without a hand.
  double frozen_s = 0.3;
  double max_support_n = 0.0;  ///< of the support's norm, >= 0, finite
};

/// \return whether every limit is in its range; NaN is out of every range
[[nodiscard]] inline bool are_valid(const SafetyLimits& limits) noexcept {
  const bool force_ok = limits.max_force_n > 0.0 && std::isfinite(limits.max_force_n) &&
                        limits.max_slew_n_per_s >= limits.max_force_n / kMaxReleaseS;
  const bool heat_ok = limits.continuous_force_n >= 0.0 && limits.thermal_budget_s > 0.0;
  const bool engaging_ok =
      limits.engage_force_n >= 0.0 && limits.ramp_up_s >= 0.0 && std::isfinite(limits.ramp_up_s);
  const bool support_ok = limits.max_support_n >= 0.0 && std::isfinite(limits.max_support_n);
  const bool readings_ok =
      limits.max_speed_mm_s > 0.0 && limits.stale_s > 0.0 && limits.frozen_s > 0.0;
  return force_ok && heat_ok && engaging_ok && support_ok && readings_ok;
}

/// \return the limits on this device: the smaller peak force and the smaller continuous force of
///   the two, the device's max_support_n, and frozen_s only for devices with encoders. NaN is
///   preserved, so that no force passes.
[[nodiscard]] inline SafetyLimits limits_on(const DeviceInfo& device,
                                            SafetyLimits limits) noexcept {
  // Unlike std::min, returns NaN if either is NaN.
  const auto smaller = [](double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return a + b;
    return a < b ? a : b;
  };
  limits.max_force_n = smaller(limits.max_force_n, device.max_force_n);
  if (limits.continuous_force_n == 0.0) {
    limits.continuous_force_n = device.continuous_force_n;
  } else if (device.continuous_force_n != 0.0) {
    limits.continuous_force_n = smaller(limits.continuous_force_n, device.continuous_force_n);
  }
  limits.max_support_n = device.max_support_n;
  // Preserves invalid values.
  if (!device.has_encoders && limits.frozen_s > 0.0) {
    limits.frozen_s = std::numeric_limits<double>::infinity();
  }
  return limits;
}

/// \pre are_valid(limits)
/// \return the longest time from any force within the limits to zero, s
[[nodiscard]] inline double max_release_s(const SafetyLimits& limits) noexcept {
  return limits.max_force_n / limits.max_slew_n_per_s;
}

}  // namespace touchtrial::device

/// \file The limits of the safety chain and their valid ranges.
#pragma once

#include "device/haptic_device.hpp"

#include <cmath>
#include <limits>

namespace touchtrial::device {

/// Every force must be able to fall to zero within this time: SafetyLimits whose slew limit takes
/// longer from max_force_n to zero are invalid.
inline constexpr double kMaxReleaseS = 0.05;

/// Limits that hold for every device. The defaults suit a hand that strokes a texture: in ordinary
/// use only the norm limit takes effect. Infinity disables a link whose limit may be infinite.
/// Invalid limits let no force pass.
struct SafetyLimits {
  double max_force_n = 3.3;          ///< of the force's norm, > 0, finite
  double continuous_force_n = 0.0;   ///< sustainable without time limit; 0: no thermal budget
  double thermal_budget_s = 20.0;    ///< at peak force, from cold, before the limit falls; > 0
  double max_slew_n_per_s = 1000.0;  ///< of the force's change, >= max_force_n / kMaxReleaseS
  double max_speed_mm_s = 2000.0;    ///< reported, or by the change of position; more is a fault
  double engage_force_n = 0.5;       ///< forces pass only after a computed force below this
  double ramp_up_s = 0.1;            ///< from engaging to full force, >= 0, finite
  double stale_s = 0.010;            ///< longest time without a new reading; then a fault; > 0
  /// Longest time at exactly the same position under at least FrozenEncoders::kPressedN; then a
  /// fault; > 0. Infinity if a weight may hang on the handle without a hand.
  double frozen_s = 0.3;
  double max_support_n = 0.0;  ///< of the support's norm, >= 0, finite
};

/// \return whether every limit is in its range; NaN is out of every range
[[nodiscard]] inline bool is_sound(const SafetyLimits& limits) noexcept {
  const bool force = limits.max_force_n > 0.0 && std::isfinite(limits.max_force_n) &&
                     limits.max_slew_n_per_s >= limits.max_force_n / kMaxReleaseS;
  const bool heat = limits.continuous_force_n >= 0.0 && limits.thermal_budget_s > 0.0;
  const bool engaging =
      limits.engage_force_n >= 0.0 && limits.ramp_up_s >= 0.0 && std::isfinite(limits.ramp_up_s);
  const bool support = limits.max_support_n >= 0.0 && std::isfinite(limits.max_support_n);
  const bool readings =
      limits.max_speed_mm_s > 0.0 && limits.stale_s > 0.0 && limits.frozen_s > 0.0;
  return force && heat && engaging && support && readings;
}

/// \return the limits on this device: the smaller of the two peak forces, and of the two continuous
///   forces; the device's limit of its support; frozen_s only for devices with encoders. NaN is
///   preserved, so that no force passes.
[[nodiscard]] inline SafetyLimits limits_on(const DeviceInfo& device,
                                            SafetyLimits limits) noexcept {
  // Unlike std::min, NaN if either is.
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

/// \pre is_sound(limits)
/// \return the longest time from any force within the limits to zero, s
[[nodiscard]] inline double let_go_s(const SafetyLimits& limits) noexcept {
  return limits.max_force_n / limits.max_slew_n_per_s;
}

}  // namespace touchtrial::device

/// \file The limits of the safety chain: what a lab may set, and what makes sense.
#pragma once

#include "device/haptic_device.hpp"

namespace touchtrial::device {

/// Within this time every force can be let go, whatever the slew limit: SafetyLimits whose slew
/// limit would need longer from max_force_n to zero are unsound.
inline constexpr double kLongestLetGoS = 0.05;

/// Limits that hold for every device. Defaults suit a hand that strokes a texture: in ordinary use
/// none of them but the norm limit is ever met. Infinity switches off a link whose limit may be
/// infinite. Limits that are not sound let no force pass.
struct SafetyLimits {
  double max_force_n = 3.3;          ///< of the force's norm, > 0, finite
  double continuous_force_n = 0.0;   ///< that the motors hold for ever; 0: no thermal budget
  double thermal_budget_s = 20.0;    ///< at peak force, from cold, before the limit falls; > 0
  double max_slew_n_per_s = 1000.0;  ///< of the force's change, >= max_force_n / kLongestLetGoS
  double max_speed_mm_s = 2000.0;    ///< reported, or by the change of position; more is a fault
  double engage_force_n = 0.5;       ///< forces pass only once the computed one was this small
  double ramp_up_s = 0.1;            ///< from engaging to full force, >= 0, finite
  double stale_s = 0.010;            ///< without a new reading, then it is a fault; > 0
};

/// Whether every limit is in its range; NaN is in none.
[[nodiscard]] bool is_sound(const SafetyLimits& limits) noexcept;

/// The limits on this device: the smaller of either's peak force, and of their continuous forces.
/// What is not a number stays so, and no force will pass.
[[nodiscard]] SafetyLimits limits_on(const DeviceInfo& device, SafetyLimits limits) noexcept;

/// Longest time from any force within the limits to zero, s. \pre is_sound(limits)
[[nodiscard]] inline double let_go_s(const SafetyLimits& limits) noexcept {
  return limits.max_force_n / limits.max_slew_n_per_s;
}

}  // namespace touchtrial::device

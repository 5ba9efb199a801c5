/// \file What every force passes on its way to a device, in a fixed order.
#pragma once

#include "core/vec.hpp"
#include "device/haptic_device.hpp"

#include <cstdint>

namespace touchtrial {

/// Limits that hold for every device. Defaults suit a hand that strokes a texture: in ordinary use
/// none of them but the norm limit is ever met.
struct SafetyLimits {
  double max_force_n = 3.3;          ///< of the force's norm, > 0
  double continuous_force_n = 0.0;   ///< that the motors hold for ever; 0: no thermal budget
  double thermal_budget_s = 20.0;    ///< at peak force, from cold, before the limit falls
  double max_slew_n_per_s = 1000.0;  ///< of the force's change, > 0
  double max_speed_mm_s = 2000.0;    ///< reported, or by the change of position; more is a fault
  double engage_force_n = 0.5;       ///< forces pass only once the computed one was this small
  double ramp_up_s = 0.1;            ///< from engaging to full force
  double stale_s = 0.010;            ///< without a new reading, then it is a fault
};

/// What the chain did to a force.
enum class SafetyVerdict {
  passed,   ///< sent as computed
  limited,  ///< shortened or held back by a link of the chain
  fault,    ///< a fault now or earlier: zero is sent until `rearm`
};

/// Why a chain latched.
enum class SafetyFault {
  none,
  not_finite,      ///< a force or position that is no number
  emergency_stop,  ///< somebody, or a signal, asked for it
  not_ready,       ///< the device lost its homing while force was on
  overspeed,       ///< faster than a hand
  stale_sample,    ///< the device gives no new readings
  stalled,         ///< the servo itself stood still (watchdog)
  device,          ///< the device reported a fault, see DeviceFault
};

struct SafeForce {
  Vec3 force_n;
  SafetyVerdict verdict = SafetyVerdict::passed;
};

/// Finite check, latched fault, norm limit. Belongs to the servo thread.
class SafetyChain {
 public:
  /// \param limits  a max_force_n that is not a number > 0 lets no force pass
  /// \param tick_s  time between two calls of `check`, > 0
  explicit SafetyChain(const SafetyLimits& limits, double tick_s = 0.001) noexcept;

  /// The force that may be sent for this tick. No allocation, lock or exception.
  [[nodiscard]] SafeForce check(Vec3 force_n, const DeviceSample& sample) noexcept;

  /// Latches a fault that was seen elsewhere; the first one stays.
  void trip(SafetyFault fault) noexcept;
  [[nodiscard]] bool faulted() const noexcept { return fault_ != SafetyFault::none; }
  [[nodiscard]] SafetyFault fault() const noexcept { return fault_; }
  /// Lets forces pass again after a fault, from the gate and the ramp on; a person's decision.
  void rearm() noexcept;

 private:
  SafetyLimits limits_;
  double tick_s_;
  SafetyFault fault_ = SafetyFault::none;
};

}  // namespace touchtrial

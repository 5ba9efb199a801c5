/// \file The safety chain, which every force passes on its way to a device. Source: docs/safety.md.
#pragma once

#include "core/vec.hpp"
#include "device/haptic_device.hpp"
#include "device/safety/safety_limits.hpp"
#include "device/safety/safety_links.hpp"

#include <cstdint>

namespace touchtrial::device {

/// What the chain did with a force.
enum class SafetyVerdict {
  passed,   ///< sent as computed
  limited,  ///< shortened or held back by a link of the chain, or by a limit of the device's own
  fault,    ///< a fault now or earlier: zero is sent until `rearm`
};

/// Why a chain latched.
enum class SafetyFault {
  none,
  not_finite,      ///< a force, position or velocity is not a finite number
  emergency_stop,  ///< a person, or a signal, asked for it
  not_ready,       ///< the device lost its homing while force was on
  overspeed,       ///< faster than a hand
  stale_sample,    ///< the device gives no new readings
  stalled,         ///< the servo itself stood still (watchdog)
  device,          ///< the device reported a fault, see DeviceFault
};

struct SafeForce {
  Vec3 force_n;  ///< to send
  SafetyVerdict verdict = SafetyVerdict::passed;
  Vec3 rendered_n{};  ///< the part of force_n that is not the device's support
};

/// In this order: finite check, latched fault, homed and armed, small-force gate on engaging,
/// velocity trip and freshness of the readings, thermal budget, ramp-up, norm limit, slew limit. A
/// fault skips the slew limit: the force is zero at once, and until `rearm`. Belongs to the servo
/// thread.
class SafetyChain {
 public:
  /// \param limits  unsound ones let no force pass
  /// \param tick_s  of the servo, finite, > 0, else no force passes
  explicit SafetyChain(const SafetyLimits& limits, double tick_s = 0.001) noexcept;

  /// A device that is not ready before engaging gets zero, without a fault. No allocation, lock or
  /// exception; about 10 ns.
  /// \param force_n  as rendered: the gate judges it alone
  /// \param ticks  since the last call, more than 1 after an overrun; less counts as 1
  /// \param support_n  HapticDevice::support_force_n, added to the rendered force: all limits judge
  ///   the sum, and the ramp holds for both
  /// \return the force that may be sent for this tick
  [[nodiscard]] SafeForce check(Vec3 force_n, const DeviceSample& sample, std::int64_t ticks = 1,
                                Vec3 support_n = {}) noexcept;

  /// Latches a fault that was seen elsewhere; the first one stays.
  void trip(SafetyFault fault) noexcept;
  [[nodiscard]] bool faulted() const noexcept { return fault_ != SafetyFault::none; }
  [[nodiscard]] SafetyFault fault() const noexcept { return fault_; }
  /// Lets forces pass again after a fault, beginning with the gate and the ramp. A person must have
  /// decided to do so.
  void rearm() noexcept;
  /// \name Heat of the motors, which outlasts a run; see ThermalBudget
  ///@{
  [[nodiscard]] double heat_n2() const noexcept { return thermal_.heat_n2(); }
  void begin_warm(double heat_n2, double rest_s) noexcept { thermal_.begin_warm(heat_n2, rest_s); }
  ///@}
  /// The force that the last `check` let pass, N.
  [[nodiscard]] Vec3 sent_n() const noexcept { return slew_.sent_n(); }

 private:
  [[nodiscard]] bool is_engaged(double force_squared_n2, const DeviceSample& sample) noexcept;
  [[nodiscard]] SafetyFault fault_in(const DeviceSample& sample, double ticks) noexcept;
  [[nodiscard]] SafeForce stopped() noexcept;
  [[nodiscard]] SafeForce limited(Vec3 force_n, Vec3 support_n) noexcept;

  bool may_engage_;
  SafetyFault fault_ = SafetyFault::none;
  EngageGate gate_;
  VelocityTrip velocity_;
  Freshness freshness_;
  ThermalBudget thermal_;
  RampUp ramp_;
  SlewLimit slew_;
};

}  // namespace touchtrial::device

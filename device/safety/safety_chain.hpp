/// \file The safety chain, which every force to a device must pass. Source: docs/safety.md.
#pragma once

#include "core/vec.hpp"
#include "device/haptic_device.hpp"
#include "device/safety/safety_limits.hpp"
#include "device/safety/safety_links.hpp"

#include <algorithm>
#include <cstdint>

namespace touchtrial::device {

/// The chain's action on a force.
enum class SafetyVerdict {
  passed,   ///< sent as computed
  limited,  ///< reduced or suppressed by a link of the chain, or by the device's own limit
  fault,    ///< latched fault: zero is sent until `rearm`
};

/// The cause of a latched chain.
enum class SafetyFault {
  none,
  not_finite,       ///< a force, position or velocity is not a finite number
  emergency_stop,   ///< requested by a person or a signal
  not_ready,        ///< the device lost its homing while force was on
  overspeed,        ///< faster than a hand
  stale_sample,     ///< the device delivers no new readings
  frozen_encoders,  ///< new readings whose position never changes under force
  stalled,          ///< the servo itself stalled (watchdog)
  device,           ///< the device reported a fault, see DeviceFault
};

struct SafeForce {
  Vec3 force_n;  ///< to send
  SafetyVerdict verdict = SafetyVerdict::passed;
  Vec3 rendered_n{};  ///< the part of force_n that is not the device's support
};

/// The chain, in this order: finite check, latched fault, homed and armed, small-force gate on
/// engaging, velocity trip, freshness of the readings and frozen encoders, thermal budget, ramp-up,
/// norm limit, slew limit; then the support is added, up to its own limit. A fault skips the slew
/// limit: the force is zero at once, and until `rearm`. Belongs to the servo thread.
class SafetyChain {
 public:
  /// \param limits  invalid ones let no force pass
  /// \param tick_s  of the servo, finite, > 0; otherwise no force passes
  explicit SafetyChain(const SafetyLimits& limits, double tick_s = 0.001) noexcept;

  /// Until the device is ready and the gate opens, the force is zero, without a fault. No
  /// allocation, lock or exception; about 10 ns.
  /// \param force_n  as rendered: gate, norm limit and slew limit apply only to it
  /// \param ticks  since the last call; more than 1 after an overrun, less than 1 counts as 1
  /// \param support_n  HapticDevice::support_force_n: limited to SafetyLimits::max_support_n and
  ///   added to the rendered force. The gate and the ramp apply to both, and both warm the motors
  /// \return the force that may be sent for this tick
  [[nodiscard]] SafeForce check(Vec3 force_n, const DeviceSample& sample, std::int64_t ticks = 1,
                                Vec3 support_n = {}) noexcept;

  /// Latches a fault detected elsewhere; the first one remains.
  void trip(SafetyFault fault) noexcept;
  [[nodiscard]] bool faulted() const noexcept { return fault_ != SafetyFault::none; }
  [[nodiscard]] SafetyFault fault() const noexcept { return fault_; }
  /// Enables forces again after a fault, starting with the gate and the ramp. A person must have
  /// decided this.
  void rearm() noexcept;
  /// \name Heat of the motors, which outlasts a run; see ThermalBudget
  ///@{
  [[nodiscard]] double heat_n2() const noexcept { return thermal_.heat_n2(); }
  void begin_warm(double heat_n2, double rest_s) noexcept { thermal_.begin_warm(heat_n2, rest_s); }
  /// @} The force passed by the last `check`, N.
  [[nodiscard]] Vec3 sent_n() const noexcept { return sent_n_; }

 private:
  [[nodiscard]] bool try_engage(double force_squared_n2, const DeviceSample& sample) noexcept;
  [[nodiscard]] SafetyFault find_fault(const DeviceSample& sample, double ticks) noexcept;
  [[nodiscard]] SafeForce stop() noexcept;
  [[nodiscard]] SafeForce apply_limits(Vec3 force_n, double force_squared_n2,
                                       Vec3 support_n) noexcept;
  /// Without support it returns the force itself, which preserves the signs of zeros.
  [[nodiscard]] static Vec3 sum_of(Vec3 force_n, Vec3 support_n) noexcept {
    return support_n == Vec3{} ? force_n : force_n + support_n;
  }

  bool may_engage_;
  double max_support_n_;
  SafetyFault fault_ = SafetyFault::none;
  EngageGate gate_;
  VelocityTrip velocity_;
  Freshness freshness_;
  FrozenEncoders frozen_;
  ThermalBudget thermal_;
  RampUp ramp_;
  SlewLimit slew_;  ///< of the rendered force
  Vec3 sent_n_;     ///< with the support
};

// Inlined into the loop, because every simulated tick passes the chain.

inline void SafetyChain::trip(SafetyFault fault) noexcept {
  if (fault_ == SafetyFault::none) fault_ = fault;
}

inline SafeForce SafetyChain::stop() noexcept {
  slew_.drop();
  sent_n_ = {};
  return {{}, SafetyVerdict::fault};
}

inline bool SafetyChain::try_engage(double force_squared_n2, const DeviceSample& sample) noexcept {
  if (gate_.is_open()) return true;
  if (!may_engage_ || !sample.ready || !gate_.try_open(force_squared_n2)) return false;
  freshness_.start(sample.sequence);
  velocity_.start(sample);
  frozen_.start(sample.position_mm);
  ramp_.start();
  return true;
}

inline SafetyFault SafetyChain::find_fault(const DeviceSample& sample, double ticks) noexcept {
  if (!sample.ready) return SafetyFault::not_ready;
  if (velocity_.is_exceeded(sample, ticks)) return SafetyFault::overspeed;
  if (freshness_.is_stale(sample.sequence, ticks)) return SafetyFault::stale_sample;
  const double pressed_n2 = dot(slew_.sent_n(), slew_.sent_n());
  if (frozen_.is_frozen(sample.position_mm, pressed_n2)) return SafetyFault::frozen_encoders;
  return SafetyFault::none;
}

/// Ramp, thermal budget, norm limit and slew limit; then the support.
inline SafeForce SafetyChain::apply_limits(Vec3 force_n, double force_squared_n2,
                                           Vec3 support_n) noexcept {
  const double share = ramp_.next_share();
  const double limit_n = thermal_.limit_n();
  // Fast path for an unlimited force without ramp or support, which is nearly every one; the steps
  // below would give the same result.
  if (share == 1.0 && support_n == Vec3{} && force_squared_n2 <= limit_n * limit_n &&
      slew_.try_reach(force_n)) {
    sent_n_ = force_n;
    return {force_n, SafetyVerdict::passed, force_n};
  }
  const Vec3 limited_support_n = share * limit_norm(support_n, max_support_n_);
  const Vec3 limited_n = limit_norm(share * force_n, thermal_.limit_n(norm(limited_support_n)));
  const Vec3 rendered_n = slew_.step_towards(limited_n);
  sent_n_ = sum_of(rendered_n, limited_support_n);
  return {sent_n_, rendered_n == force_n ? SafetyVerdict::passed : SafetyVerdict::limited,
          rendered_n};
}

inline SafeForce SafetyChain::check(Vec3 force_n, const DeviceSample& sample, std::int64_t ticks,
                                    Vec3 support_n) noexcept {
  const auto elapsed = static_cast<double>(std::max<std::int64_t>(ticks, 1));
  const double force_squared_n2 = dot(force_n, force_n);
  thermal_.heat(dot(sent_n_, sent_n_), elapsed);
  if (!is_finite_state(force_squared_n2 + dot(support_n, support_n), sample))
    trip(SafetyFault::not_finite);
  if (faulted()) return stop();
  const bool was_engaged = gate_.is_open();
  if (!try_engage(force_squared_n2, sample)) {
    return {{}, force_n == Vec3{} ? SafetyVerdict::passed : SafetyVerdict::limited};
  }
  if (was_engaged) trip(find_fault(sample, elapsed));
  if (faulted()) return stop();
  return apply_limits(force_n, force_squared_n2, support_n);
}

}  // namespace touchtrial::device

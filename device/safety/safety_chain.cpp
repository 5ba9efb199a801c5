#include "device/safety/safety_chain.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::device {
namespace {

/// Without a support, the force itself with the signs of its zeros.
Vec3 sum_of(Vec3 force_n, Vec3 support_n) noexcept {
  return support_n == Vec3{} ? force_n : force_n + support_n;
}

}  // namespace

SafetyChain::SafetyChain(const SafetyLimits& limits, double tick_s) noexcept
    : may_engage_(is_sound(limits) && tick_s > 0.0 && std::isfinite(tick_s)),
      gate_(limits.engage_force_n),
      velocity_(limits.max_speed_mm_s, tick_s),
      freshness_(limits.stale_s, tick_s),
      thermal_(limits, tick_s),
      ramp_(limits.ramp_up_s, tick_s),
      slew_(limits.max_slew_n_per_s, tick_s) {}

void SafetyChain::trip(SafetyFault fault) noexcept {
  if (fault_ == SafetyFault::none) fault_ = fault;
}

void SafetyChain::rearm() noexcept {
  fault_ = SafetyFault::none;
  gate_.close();
  slew_.drop();
}

SafeForce SafetyChain::stopped() noexcept {
  slew_.drop();
  return {{}, SafetyVerdict::fault};
}

bool SafetyChain::is_engaged(double force_squared_n2, const DeviceSample& sample) noexcept {
  if (gate_.is_open()) return true;
  if (!may_engage_ || !sample.ready || !gate_.try_open(force_squared_n2)) return false;
  freshness_.start(sample.sequence);
  velocity_.start(sample);
  ramp_.start();
  return true;
}

SafetyFault SafetyChain::fault_in(const DeviceSample& sample, double ticks) noexcept {
  if (!sample.ready) return SafetyFault::not_ready;
  if (velocity_.is_exceeded(sample, ticks)) return SafetyFault::overspeed;
  if (freshness_.is_stale(sample.sequence, ticks)) return SafetyFault::stale_sample;
  return SafetyFault::none;
}

/// Ramp, thermal budget, norm limit and slew limit.
SafeForce SafetyChain::limited(Vec3 force_n, Vec3 support_n) noexcept {
  const double share = ramp_.next_share();
  const Vec3 carried_n = share * support_n;
  const Vec3 ramped_n = sum_of(share * force_n, carried_n);
  const Vec3 allowed_n = within_norm(ramped_n, thermal_.limit_n());
  const Vec3 safe_n = slew_.towards(allowed_n);
  if (safe_n == sum_of(force_n, carried_n)) return {safe_n, SafetyVerdict::passed, force_n};
  const double squared_n2 = dot(ramped_n, ramped_n);
  const double kept = squared_n2 > 0.0 ? dot(allowed_n, ramped_n) / squared_n2 : 1.0;
  return {safe_n, SafetyVerdict::limited, support_n == Vec3{} ? safe_n : safe_n - kept * carried_n};
}

SafeForce SafetyChain::check(Vec3 force_n, const DeviceSample& sample, std::int64_t ticks,
                             Vec3 support_n) noexcept {
  const auto elapsed = static_cast<double>(std::max<std::int64_t>(ticks, 1));
  const double force_squared_n2 = dot(force_n, force_n);
  thermal_.heat(dot(slew_.sent_n(), slew_.sent_n()), elapsed);
  if (!is_finite_state(force_squared_n2 + dot(support_n, support_n), sample))
    trip(SafetyFault::not_finite);
  if (faulted()) return stopped();
  const bool was_engaged = gate_.is_open();
  if (!is_engaged(force_squared_n2, sample)) {
    return {{}, force_n == Vec3{} ? SafetyVerdict::passed : SafetyVerdict::limited};
  }
  if (was_engaged) trip(fault_in(sample, elapsed));
  if (faulted()) return stopped();
  return limited(force_n, support_n);
}

}  // namespace touchtrial::device

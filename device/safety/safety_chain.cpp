#include "device/safety/safety_chain.hpp"

#include <cmath>

namespace touchtrial {

SafetyChain::SafetyChain(const SafetyLimits& limits, double tick_s) noexcept
    : limits_(limits), tick_s_(tick_s) {}

void SafetyChain::trip(SafetyFault fault) noexcept {
  if (fault_ == SafetyFault::none) fault_ = fault;
}

void SafetyChain::rearm() noexcept {
  fault_ = SafetyFault::none;
}

SafeForce SafetyChain::check(Vec3 force_n, const DeviceSample& sample) noexcept {
  const double strength_n = norm(force_n);
  // The norm also overflows to infinity for a force that is absurd without being infinite.
  if (!std::isfinite(strength_n) || !is_finite(sample.position_mm)) trip(SafetyFault::not_finite);
  if (faulted()) return {{}, SafetyVerdict::fault};
  if (strength_n <= limits_.max_force_n) return {force_n, SafetyVerdict::passed};
  if (!(limits_.max_force_n > 0.0)) return {{}, SafetyVerdict::limited};
  return {(limits_.max_force_n / strength_n) * force_n, SafetyVerdict::limited};
}

}  // namespace touchtrial

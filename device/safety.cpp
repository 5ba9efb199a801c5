#include "device/safety.hpp"

#include <cmath>

namespace touchtrial {

SafeForce SafetyChain::check(Vec3 force_n) noexcept {
  const double strength_n = norm(force_n);
  // The norm also overflows to infinity for a force that is absurd without being infinite.
  if (!std::isfinite(strength_n)) faulted_ = true;
  if (faulted_) return {{}, SafetyVerdict::fault};
  if (strength_n <= max_force_n_) return {force_n, SafetyVerdict::passed};
  if (!(max_force_n_ > 0.0)) return {{}, SafetyVerdict::limited};
  return {(max_force_n_ / strength_n) * force_n, SafetyVerdict::limited};
}

}  // namespace touchtrial

/// \file What every force passes on its way to a device, in a fixed order.
#pragma once

#include "core/vec.hpp"

namespace touchtrial {

/// What the chain did to a force.
enum class SafetyVerdict {
  passed,   ///< sent as computed
  limited,  ///< shortened to the maximum, direction kept
  fault,    ///< not a finite force now or earlier: zero is sent until `rearm`
};

struct SafeForce {
  Vec3 force_n;
  SafetyVerdict verdict = SafetyVerdict::passed;
};

/// Finite check, latched fault, norm limit. Belongs to the servo thread.
class SafetyChain {
 public:
  /// \param max_force_n  limit of the force's norm; a limit that is not a number > 0 lets no force
  ///   pass
  explicit SafetyChain(double max_force_n) noexcept : max_force_n_(max_force_n) {}

  /// The force that may be sent for this tick. No allocation, lock or exception.
  [[nodiscard]] SafeForce check(Vec3 force_n) noexcept;

  [[nodiscard]] bool faulted() const noexcept { return faulted_; }
  /// Lets forces pass again after a fault; a person's decision.
  void rearm() noexcept { faulted_ = false; }

 private:
  double max_force_n_;
  bool faulted_ = false;
};

}  // namespace touchtrial

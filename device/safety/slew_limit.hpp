/// \file Link of the safety chain: how fast a force may change.
#pragma once

#include "device/safety/norm_limit.hpp"

namespace touchtrial::device {

/// Follows the forces it is given, by at most one step a call. Late calls get no longer steps: the
/// hand feels a step, whatever time went before it.
class SlewLimit {
 public:
  /// \param max_slew_n_per_s  > 0; infinity: no limit
  /// \param tick_s  of the servo, > 0
  SlewLimit(double max_slew_n_per_s, double tick_s) noexcept : step_n_(max_slew_n_per_s * tick_s) {}

  [[nodiscard]] Vec3 towards(Vec3 force_n) noexcept {
    const Vec3 change_n = force_n - sent_n_;
    const Vec3 step_n = within_norm(change_n, step_n_);
    // The very force where it may be sent: a sum of differences would round.
    sent_n_ = step_n == change_n ? force_n : sent_n_ + step_n;
    return sent_n_;
  }

  /// Zero now: the way of a fault.
  void drop() noexcept { sent_n_ = {}; }
  [[nodiscard]] Vec3 sent_n() const noexcept { return sent_n_; }

 private:
  double step_n_;
  Vec3 sent_n_;
};

}  // namespace touchtrial::device

/// \file Link of the safety chain: after engaging, forces grow to their full size.
#pragma once

#include "core/vec.hpp"

namespace touchtrial::device {

/// A factor that grows evenly from 0 to 1. It counts calls and not time: a servo that slept has not
/// shown the hand what it missed.
class RampUp {
 public:
  /// \param ramp_s  >= 0, finite; 0: none
  /// \param tick_s  of the servo, > 0
  RampUp(double ramp_s, double tick_s) noexcept
      : share_per_tick_(ramp_s > tick_s ? tick_s / ramp_s : 1.0),
        first_(ramp_s > 0.0 ? 0.0 : 1.0) {}

  void start() noexcept { share_ = first_; }

  /// The force of this tick.
  [[nodiscard]] Vec3 of(Vec3 force_n) noexcept {
    if (share_ >= 1.0) return force_n;
    const double share = share_;
    share_ += share_per_tick_;
    return share * force_n;
  }

 private:
  double share_per_tick_;
  double first_;
  double share_ = 1.0;
};

}  // namespace touchtrial::device

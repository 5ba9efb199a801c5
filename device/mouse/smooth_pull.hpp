/// \file A point that is drawn to another without ever passing it.
#pragma once

#include "core/vec.hpp"

namespace touchtrial::device {

/// A critically damped mass on a spring, whose far end is moved about: two first-order lags in a
/// row, each by the implicit Euler rule. What it gives is a weighted mean of what it was given, at
/// any step, so it stays within the same bounds, and it comes to rest at a target that rests.
class SmoothPull {
 public:
  /// \param time_constant_s  of either lag, > 0; the spring's natural frequency is 1 / (2 pi times
  ///   it)
  explicit SmoothPull(double time_constant_s) noexcept : time_constant_s_(time_constant_s) {}

  /// \param step_s  time since the last step, >= 0
  void step(Vec2 target, double step_s) noexcept {
    const double share = step_s / (time_constant_s_ + step_s);
    between_ = between_ + share * (target - between_);
    const Vec2 change = share * (between_ - value_);
    value_ = value_ + change;
    if (step_s > 0.0) rate_ = (1.0 / step_s) * change;
  }

  /// To rest at this place.
  void reset(Vec2 value) noexcept {
    between_ = value;
    value_ = value;
    rate_ = {};
  }

  [[nodiscard]] Vec2 value() const noexcept { return value_; }
  [[nodiscard]] Vec2 rate_per_s() const noexcept { return rate_; }

 private:
  double time_constant_s_;
  Vec2 between_;
  Vec2 value_;
  Vec2 rate_;
};

}  // namespace touchtrial::device

/// \file Friction as a bristle: a spring from the stylus to where it holds on to the plane, which
/// slips when it is stretched too far. Source: docs/method.md, "Rendering".
#pragma once

#include "core/vec.hpp"

#include <cmath>

namespace touchtrial::engine {

/// What a touch leaves for the next tick; one for each presentation. The bristle goes by positions
/// alone, never by time: a path gives the same forces however fast it is stroked. It is passive:
/// what it stores it has got from the hand, and slipping only loses.
class Bristle {
 public:
  /// The friction on a stylus that has moved to a point of the plane; the first point after a
  /// release is where the bristle takes hold. \param at_mm  finite
  /// \param limit_n  mu * F_N, >= 0: the bristle slips at this force
  /// \param stiffness_n_per_mm  of the bristle, > 0
  /// \return of norm <= limit_n, but for rounding. No allocation, lock or exception.
  [[nodiscard]] Vec2 friction_n(Vec2 at_mm, double limit_n, double stiffness_n_per_mm) noexcept {
    if (!holds_) anchor_mm_ = at_mm;
    holds_ = true;
    Vec2 stretch_mm = at_mm - anchor_mm_;
    const double spring_n = stiffness_n_per_mm * norm(stretch_mm);
    if (spring_n > limit_n) {
      stretch_mm = (limit_n / spring_n) * stretch_mm;
      anchor_mm_ = at_mm - stretch_mm;
    }
    return -stiffness_n_per_mm * stretch_mm;
  }

  /// The stylus has left the plane.
  void release() noexcept { holds_ = false; }

 private:
  Vec2 anchor_mm_;
  bool holds_ = false;
};

}  // namespace touchtrial::engine

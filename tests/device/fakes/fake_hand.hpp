/// \file A hand on a fake device: a point that a steady push and the device's force move.
#pragma once

#include "core/vec.hpp"

#include <atomic>

namespace touchtrial::fakes {

/// A vector that a test and a fake's thread share; each coordinate by itself.
class SharedVec {
 public:
  void set(Vec3 v) noexcept {
    x_.store(v.x, std::memory_order_relaxed);
    y_.store(v.y, std::memory_order_relaxed);
    z_.store(v.z, std::memory_order_relaxed);
  }
  [[nodiscard]] Vec3 get() const noexcept {
    return {x_.load(std::memory_order_relaxed), y_.load(std::memory_order_relaxed),
            z_.load(std::memory_order_relaxed)};
  }

 private:
  std::atomic<double> x_{0.0};
  std::atomic<double> y_{0.0};
  std::atomic<double> z_{0.0};
};

/// Moves through thick oil, a millisecond a step: velocity = (push + force) / damping. Against a
/// wall it settles where the wall bears the push. All relaxed: it orders nothing for the driver.
class FakeHand {
 public:
  static constexpr double kDampingNSPerMm = 0.008;
  static constexpr double kStepS = 0.001;

  void step(Vec3 force_n) noexcept {
    const Vec3 velocity_mm_s = (1.0 / kDampingNSPerMm) * (push_n.get() + force_n);
    velocity.set(velocity_mm_s);
    position_mm.set(position_mm.get() + kStepS * velocity_mm_s);
  }
  void rest_at(Vec3 place_mm) noexcept {
    push_n.set({});
    velocity.set({});
    position_mm.set(place_mm);
  }

  SharedVec push_n;
  SharedVec position_mm;
  SharedVec velocity;  ///< mm/s
};

}  // namespace touchtrial::fakes

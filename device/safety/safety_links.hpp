/// \file The links of the safety chain, in the order in which a force passes them. Source:
/// docs/safety.md. Private to this folder.
///
/// Every link belongs to the servo thread; none allocates, locks or throws. A link with an infinite
/// limit has no effect.
#pragma once

#include "core/vec.hpp"
#include "device/haptic_device.hpp"
#include "device/safety/safety_limits.hpp"
#include "device/safety/thermal_budget.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace touchtrial::device {

/// Tolerance for whole numbers of ticks: 0.010 / 0.001 is 10 ticks, not 11.
inline constexpr double kTickRounding = 1e-6;

/// \return whether force, position and velocity are finite. Values whose squares overflow also count
///   as not finite.
[[nodiscard]] inline bool is_finite_state(double force_squared_n2,
                                          const DeviceSample& sample) noexcept {
  const double all = force_squared_n2 + dot(sample.position_mm, sample.position_mm) +
                     dot(sample.velocity_mm_s, sample.velocity_mm_s);
  return all <= std::numeric_limits<double>::max();
}

/// Prevents a force from starting with a jolt. Opens once the computed force is small, that is,
/// with the hand off the plane or barely touching it; then stays open until closed.
class EngageGate {
 public:
  /// \param engage_force_n  >= 0; infinity: opens at once
  explicit EngageGate(double engage_force_n) noexcept
      : squared_n2_(engage_force_n * engage_force_n) {}

  [[nodiscard]] bool is_open() const noexcept { return open_; }
  /// \return whether it is open now
  [[nodiscard]] bool try_open(double force_squared_n2) noexcept {
    open_ = open_ || force_squared_n2 <= squared_n2_;
    return open_;
  }
  void close() noexcept { open_ = false; }

 private:
  double squared_n2_;
  bool open_ = false;
};

/// Trips on motion faster than a hand's: by the reported speed, or by the change of position since
/// an earlier reading. Two readings from another thread or a bus may arrive together, so the change
/// is measured over at least kWindowS.
class VelocityTrip {
 public:
  static constexpr double kWindowS = 0.001;

  /// \param max_speed_mm_s  > 0; infinity: no limit
  /// \param tick_s  of the servo, > 0
  VelocityTrip(double max_speed_mm_s, double tick_s) noexcept
      : speed_squared_(max_speed_mm_s * max_speed_mm_s),
        change_squared_(speed_squared_ * tick_s * tick_s),
        window_ticks_(std::max(1.0, std::ceil(kWindowS / tick_s - kTickRounding))) {}

  /// Starts from this reading.
  void start(const DeviceSample& sample) noexcept {
    reference_mm_ = sample.position_mm;
    sequence_ = sample.sequence;
    ticks_ = 0.0;
  }

  /// \param sample  finite
  /// \param ticks  since the last call, >= 1
  [[nodiscard]] bool is_exceeded(const DeviceSample& sample, double ticks) noexcept {
    ticks_ += ticks;
    const double time = std::max(ticks_, window_ticks_);
    const Vec3 change_mm = sample.position_mm - reference_mm_;
    const bool exceeded = !(dot(sample.velocity_mm_s, sample.velocity_mm_s) <= speed_squared_) ||
                          !(dot(change_mm, change_mm) <= change_squared_ * (time * time));
    const bool is_new = sample.sequence != sequence_;
    sequence_ = sample.sequence;
    if (is_new && ticks_ >= window_ticks_) start(sample);
    return exceeded;
  }

 private:
  double speed_squared_;   ///< mm^2/s^2
  double change_squared_;  ///< in one tick, mm^2
  double window_ticks_;
  Vec3 reference_mm_;
  double ticks_ = 0.0;  ///< since the reading at from_mm_
  std::uint64_t sequence_ = 0;
};

/// Detects a lack of new readings. A device slower than the servo repeats its sequence number
/// between readings; that is a fault only after stale_s.
class Freshness {
 public:
  /// \param stale_s  > 0; infinity: never
  /// \param tick_s  of the servo, > 0
  Freshness(double stale_s, double tick_s) noexcept
      : stale_ticks_(std::max(1.0, std::ceil(stale_s / tick_s - kTickRounding))),
        max_step_(std::max(1.0, 0.5 * stale_ticks_)) {}

  void start(std::uint64_t sequence) noexcept {
    sequence_ = sequence;
    ticks_without_reading_ = 0.0;
  }

  /// \param ticks  since the last call, >= 1. After a pause of the process the first reading may be
  ///   old, so one call counts for half of stale_s at most.
  [[nodiscard]] bool is_stale(std::uint64_t sequence, double ticks) noexcept {
    if (sequence != sequence_) {
      start(sequence);
      return false;
    }
    ticks_without_reading_ += std::min(ticks, max_step_);
    return ticks_without_reading_ >= stale_ticks_;
  }

 private:
  double stale_ticks_;
  double max_step_;
  double ticks_without_reading_ = 0.0;
  std::uint64_t sequence_ = 0;
};

/// Detects encoders that stop while the device runs: new readings at exactly the same position. A
/// pressing hand always trembles by more than an encoder step. Counts calls instead of time,
/// because missed ticks had no reading.
class FrozenEncoders {
 public:
  /// Under less force the hand may have let go of the handle.
  static constexpr double kPressedN = 1.0;

  /// \param frozen_s  > 0; infinity: never
  /// \param tick_s  of the servo, > 0
  FrozenEncoders(double frozen_s, double tick_s) noexcept
      : frozen_ticks_(std::max(1.0, std::ceil(frozen_s / tick_s - kTickRounding))) {}

  /// Starts from this position.
  void start(Vec3 position_mm) noexcept {
    position_mm_ = position_mm;
    still_ticks_ = 0.0;
  }

  /// \param pressed_squared_n2  the square of the force on the hand, without the support
  [[nodiscard]] bool is_frozen(Vec3 position_mm, double pressed_squared_n2) noexcept {
    if (position_mm != position_mm_ || !(pressed_squared_n2 >= kPressedN * kPressedN)) {
      start(position_mm);
      return false;
    }
    still_ticks_ += 1.0;
    return still_ticks_ >= frozen_ticks_;
  }

 private:
  double frozen_ticks_;
  double still_ticks_ = 0.0;
  Vec3 position_mm_;
};

/// Ramps forces up after engaging, by a factor that rises linearly from 0 to 1. Counts calls
/// instead of time, because the hand did not feel missed ticks.
class RampUp {
 public:
  /// \param ramp_s  >= 0, finite; 0: none
  /// \param tick_s  of the servo, > 0
  RampUp(double ramp_s, double tick_s) noexcept
      : share_per_tick_(ramp_s > tick_s ? tick_s / ramp_s : 1.0),
        first_share_(ramp_s > 0.0 ? 0.0 : 1.0) {}

  void start() noexcept { share_ = first_share_; }

  /// \return this tick's share of the force, in [0, 1]
  [[nodiscard]] double next_share() noexcept {
    if (share_ >= 1.0) return 1.0;
    const double share = share_;
    share_ += share_per_tick_;
    return share;
  }

 private:
  double share_per_tick_;
  double first_share_;
  double share_ = 1.0;
};

/// \param force_n  a force whose square is finite
/// \param limit_n  > 0, finite
/// \return the force, scaled down to the limit if it exceeds it
[[nodiscard]] inline Vec3 limit_norm(Vec3 force_n, double limit_n) noexcept {
  const double squared_n2 = dot(force_n, force_n);
  if (squared_n2 <= limit_n * limit_n) return force_n;
  return (limit_n / std::sqrt(squared_n2)) * force_n;
}

/// Approaches the given force by at most one step per call. The step after a pause is not larger,
/// because the hand feels the step, not the pause.
class SlewLimit {
 public:
  /// \param max_slew_n_per_s  > 0; infinity: no limit
  /// \param tick_s  of the servo, > 0
  SlewLimit(double max_slew_n_per_s, double tick_s) noexcept : step_n_(max_slew_n_per_s * tick_s) {}

  [[nodiscard]] Vec3 step_towards(Vec3 force_n) noexcept {
    const Vec3 change_n = force_n - sent_n_;
    const Vec3 step_n = limit_norm(change_n, step_n_);
    // A force within one step is used directly, because adding differences would round.
    sent_n_ = step_n == change_n ? force_n : sent_n_ + step_n;
    return sent_n_;
  }

  /// Acts as `step_towards` if one step suffices; otherwise has no effect.
  /// \return whether it sufficed
  [[nodiscard]] bool try_reach(Vec3 force_n) noexcept {
    const Vec3 change_n = force_n - sent_n_;
    if (!(dot(change_n, change_n) <= step_n_ * step_n_)) return false;
    sent_n_ = force_n;
    return true;
  }

  /// Sets zero at once, for a fault.
  void drop() noexcept { sent_n_ = {}; }
  [[nodiscard]] Vec3 sent_n() const noexcept { return sent_n_; }

 private:
  double step_n_;
  Vec3 sent_n_;
};

}  // namespace touchtrial::device

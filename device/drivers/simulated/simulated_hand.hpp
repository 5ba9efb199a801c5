/// \file A simulated device and hand: the hand follows a path of straight lateral strokes between
/// random points, pushes, and yields to forces.
#pragma once

#include "core/plane_geometry.hpp"
#include "core/random.hpp"
#include "core/vec.hpp"
#include "device/drivers/simulated/hand_on_tip.hpp"
#include "device/haptic_device.hpp"
#include "device/model/device_model.hpp"
#include "device/servo/servo.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::device {

struct ExplorationOptions {
  double slowest_mm_s = 50.0;   ///< of a stroke's steady part, > 0
  double fastest_mm_s = 150.0;  ///< >= slowest
  double margin_mm = 8.0;       ///< distance from the plane's edge, >= 0; at most a fifth of a side
  double duration_s = 10.0;     ///< > 0
};

/// Strokes end to end. Each starts and ends at rest, speeds up and slows down smoothly (continuous
/// acceleration), and keeps its speed in between. End points are uniform within the margin and at
/// least half the shorter side apart, so that direction and offset differ with every stroke; speeds
/// are uniform in the range. Strokes are slower on a plane too short for the speed.
class ExplorationPath {
 public:
  /// The duration of speeding up, and of slowing down.
  static constexpr double kRampS = 0.08;

  /// \throws std::invalid_argument if the plane has no area or an option is out of range
  ExplorationPath(const PlaneGeometry& plane, const ExplorationOptions& options,
                  RandomStream& random);

  /// \param time_s  >= 0, not decreasing between calls; after the last stroke the path stays at its
  ///   end
  /// \param stroke  the state of the search, which the caller passes from call to call; 0 at first
  [[nodiscard]] PathPoint at(double time_s, std::size_t& stroke) const noexcept;

 private:
  struct Stroke {
    double start_s = 0.0;
    double steady_s = 0.0;  ///< duration less one ramp, so that length = speed * steady_s
    double speed_mm_s = 0.0;
    Vec2 from_mm;
    Vec2 direction;  ///< of length 1
    [[nodiscard]] double end_s() const noexcept { return start_s + steady_s + kRampS; }
  };
  /// The effect of speeding up and slowing down on a stroke.
  struct Ramps {
    double way_s;  ///< covered on ramps, in seconds of the stroke's speed
    double speed;  ///< share of the stroke's speed
  };
  /// \param gone_s, left_s  since the stroke's start and until its end
  [[nodiscard]] static Ramps ramps_at(double gone_s, double left_s) noexcept;
  [[nodiscard]] static Stroke stroke_between(Vec2 from_mm, Vec2 to_mm, double start_s,
                                             double speed_mm_s) noexcept;

  std::vector<Stroke> strokes_;
};

/// \return the name of a simulated hand's device in records: "simulated", with the model's name
///   unless ideal
[[nodiscard]] std::string words_of_simulated(const DeviceModel& held);

/// Receives what a simulated hand feels at its tip.
class TipSense {
 public:
  virtual ~TipSense() = default;
  /// One tick, on the thread of the servo. Must not block, allocate or throw.
  /// \param force_n  commanded for the tick
  /// \param acceleration_m_s2  of the tip, minus the hand's own
  virtual void feel(const Vec3& position_mm, const Vec3& force_n,
                    const Vec3& acceleration_m_s2) noexcept = 0;
};

/// The driver "simulated". Along the plane the arm pulls the hand towards the path. A push, which
/// builds up smoothly while the hand comes down from above, presses it on the plane. The servo's
/// forces move it, through the device that it holds: an ideal one unless a model is given
/// (device/model). Virtual time: each `write` is one tick. The motion depends on the options,
/// the path, the device and the forces alone. Not thread-safe.
class SimulatedHand final : public HapticDevice {
 public:
  /// The time in which the push builds up, s.
  static constexpr double kPushBuildUpS = 0.3;

  /// The hand starts above the path's first point.
  /// \param device  its mass adds to the hand's; in the plane frame, its workspace is ignored
  /// \throws std::invalid_argument if an option or a parameter of the device is out of range
  SimulatedHand(const HandOptions& options, ExplorationPath path, const DeviceModel& device = {});

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// Does nothing: a force lasts for its own tick only.
  void halt() noexcept override {}
  void rearm() noexcept override {}

  /// \return the virtual time since the hand was made
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept;

  /// Before the first tick.
  /// \param sense  called at every tick; must outlive the hand
  void feel_by(TipSense& sense);

  /// Precomputes, before the first tick, the hand's whole motion without forces. Later copies share
  /// it, which halves the cost of many explorations along one path; results are unchanged.
  void precompute();

  /// The tip's velocity relative to the motion of the same hand and device without forces, because
  /// people know how a device feels in the air. Across the plane, the velocity itself. At the end
  /// of the last tick.
  /// \pre feel_by
  [[nodiscard]] Vec3 yielding_velocity_mm_s() const noexcept { return yielding_mm_s_; }

 private:
  /// The arm's intention in a tick.
  struct Intention {
    PathPoint target;
    double push_n = 0.0;
  };
  /// The same, and the tip's velocity after the tick if nothing pushed it.
  struct FreeTick {
    Intention intention;
    Vec2 tip_mm_s;
  };
  [[nodiscard]] Intention intention_at(std::int64_t tick, std::size_t& stroke) const noexcept;
  [[nodiscard]] HeldDevice unforced() const;
  void update_sense(TipSense& sense, Vec3 tip_mm, Vec3 force_n, const Intention& intention,
                    const FreeTick* foreseen) noexcept;

  HandOptions options_;
  ExplorationPath path_;
  HeldDevice held_;
  double max_force_n_;  ///< of hand and device, the smaller one
  DeviceModel device_;
  TipSense* sense_ = nullptr;
  Vec3 yielding_mm_s_;
  std::optional<HeldDevice> unforced_;  ///< with a TipSense: the motion without forces
  std::shared_ptr<const std::vector<FreeTick>>
      precomputed_;  ///< instead of `unforced_`; null: not precomputed
  std::size_t stroke_ = 0;
  std::int64_t tick_ = 0;
  std::int64_t last_tick_;
};

// Inlined into the servo's loop, because every simulated tick uses them.

inline PathPoint ExplorationPath::at(double time_s, std::size_t& stroke) const noexcept {
  while (stroke + 1 < strokes_.size() && time_s >= strokes_[stroke].end_s()) ++stroke;
  const Stroke& s = strokes_[stroke];
  const double gone_s = time_s - s.start_s;
  const double left_s = s.end_s() - time_s;
  const double steady_s = std::clamp(gone_s - kRampS, 0.0, s.steady_s - kRampS);
  // Speeding up has covered half a ramp by then, and slowing down nothing.
  const bool is_steady = gone_s >= kRampS && left_s >= kRampS;
  const Ramps ramps = is_steady ? Ramps{0.5 * kRampS, 1.0} : ramps_at(gone_s, left_s);
  const double speed_mm_s = s.speed_mm_s * ramps.speed;
  return {s.from_mm + (s.speed_mm_s * (steady_s + ramps.way_s)) * s.direction,
          speed_mm_s * s.direction};
}

inline SimulatedHand::Intention SimulatedHand::intention_at(std::int64_t tick,
                                                            std::size_t& stroke) const noexcept {
  const double time_s = static_cast<double>(tick) * kServoTickS;
  double share = 1.0;  // of the push: from 0 to 1, level at both ends
  if (time_s < kPushBuildUpS) {
    const double u = time_s / kPushBuildUpS;
    share = u * u * (3.0 - 2.0 * u);
  }
  return {path_.at(time_s, stroke), options_.push_n * share};
}

inline DeviceStatus SimulatedHand::read(DeviceSample& sample) noexcept {
  sample = {by_number(held_.device.read_position_mm()),
            by_number(held_.device.read_velocity_mm_s()), static_cast<std::uint64_t>(tick_) + 1};
  return tick_ < last_tick_ ? DeviceStatus::ok : DeviceStatus::stopped;
}

inline DeviceStatus SimulatedHand::write(Vec3 force_n) noexcept {
  const FreeTick* foreseen = nullptr;
  if (precomputed_ != nullptr) foreseen = &(*precomputed_)[std::min(tick_, last_tick_)];
  const Intention intention =
      foreseen != nullptr ? foreseen->intention : intention_at(tick_, stroke_);
  const Vec3 tip_mm = by_number(held_.device.true_position_mm());
  held_.tick(force_n, intention.target, intention.push_n);
  ++tick_;
  if (sense_ != nullptr) update_sense(*sense_, tip_mm, force_n, intention, foreseen);
  return DeviceStatus::ok;
}

inline void SimulatedHand::update_sense(TipSense& sense, Vec3 tip_mm, Vec3 force_n,
                                        const Intention& intention,
                                        const FreeTick* foreseen) noexcept {
  Vec2 own_mm_s;
  if (foreseen != nullptr) {
    own_mm_s = foreseen->tip_mm_s;
  } else {
    static_cast<void>(unforced_->tick({}, intention.target, intention.push_n));
    const Vec3& free_mm_s = unforced_->device.true_velocity_mm_s();
    own_mm_s = {free_mm_s.x, free_mm_s.y};
  }
  const Vec3 before_mm_s = by_number(yielding_mm_s_);
  yielding_mm_s_ = held_.device.true_velocity_mm_s() - Vec3{own_mm_s.x, own_mm_s.y, 0.0};
  // mm/s in a tick of 1 ms are m/s^2.
  static_assert(kServoTick == std::chrono::milliseconds(1));
  sense.feel(tip_mm, force_n, yielding_mm_s_ - before_mm_s);
}

}  // namespace touchtrial::device

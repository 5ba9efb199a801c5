/// \file A simulated device and hand: the hand strokes the plane along a path of straight lines
/// between random points, pushes on it, and yields to forces.
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

/// A sequence of strokes, each from the end of the last. A stroke starts and ends at rest, speeds
/// up and slows down smoothly (continuous acceleration), and has a constant speed in between. End
/// points are uniform within the margin and at least half the shorter side apart, so that direction
/// and offset differ between strokes; speeds are uniform in the range. Strokes are slower on a
/// plane too short for the speed.
class ExplorationPath {
 public:
  /// The duration of speeding up, and of slowing down.
  static constexpr double kRampS = 0.08;

  /// \throws std::invalid_argument if the plane has no area or an option is out of range
  ExplorationPath(const PlaneGeometry& plane, const ExplorationOptions& options,
                  RandomStream& random);

  /// \param time_s  >= 0, not decreasing between calls; after the last stroke the path stays at its
  ///   end
  /// \param stroke  index of the current stroke, updated by each call; 0 in the first call
  [[nodiscard]] PathPoint at(double time_s, std::size_t& stroke) const noexcept;

 private:
  struct Stroke {
    double start_s = 0.0;
    double steady_s = 0.0;  ///< duration minus one ramp, so that length = speed * steady_s
    double speed_mm_s = 0.0;
    Vec2 start_mm;
    Vec2 direction;  ///< of length 1
    [[nodiscard]] double end_s() const noexcept { return start_s + steady_s + kRampS; }
  };
  /// The effect of the ramps, in which a stroke speeds up and slows down, at one time.
  struct Ramps {
    double distance_s;   ///< distance covered on ramps, divided by the stroke's speed
    double speed_share;  ///< of the stroke's speed
  };
  /// \param elapsed_s, remaining_s  since the stroke's start and until its end
  [[nodiscard]] static Ramps ramps_at(double elapsed_s, double remaining_s) noexcept;
  [[nodiscard]] static Stroke stroke_between(Vec2 start_mm, Vec2 end_mm, double start_s,
                                             double speed_mm_s) noexcept;

  std::vector<Stroke> strokes_;
};

/// \return the name of the simulated device in records: "simulated", followed by the held model's
///   name unless it is ideal
[[nodiscard]] std::string simulated_device_name(const DeviceModel& held);

/// Receives the forces and motion that a simulated hand feels at its tip.
class TipSense {
 public:
  virtual ~TipSense() = default;
  /// Called once per tick on the servo thread. Must not block, allocate or throw.
  /// \param force_n  commanded for the tick
  /// \param acceleration_m_s2  of the tip, relative to the motion without forces
  virtual void feel(const Vec3& position_mm, const Vec3& force_n,
                    const Vec3& acceleration_m_s2) noexcept = 0;
};

/// The driver "simulated". Along the plane the arm pulls the hand towards the path. A push, which
/// builds up smoothly while the hand descends, presses it on the plane. The servo's forces move the
/// hand through the device that it holds: an ideal one unless a model is given (device/model).
/// Virtual time: each `write` is one tick. The motion depends only on the options, the path, the
/// device and the forces. Not thread-safe.
class SimulatedHand final : public HapticDevice {
 public:
  /// The time in which the push builds up, s.
  static constexpr double kPushBuildUpS = 0.3;

  /// The hand starts above the path's first point.
  /// \param device  in the plane frame; its mass adds to the hand's, and its workspace is ignored
  /// \throws std::invalid_argument if an option or a parameter of the device is out of range
  SimulatedHand(const HandOptions& options, ExplorationPath path, const DeviceModel& device = {});

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// Does nothing: a force lasts for one tick only.
  void halt() noexcept override {}
  void rearm() noexcept override {}

  /// \return the virtual time since construction
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept;

  /// Sets the receiver of what the hand feels. Call it before the first tick.
  /// \param sense  must outlive the hand
  void set_sense(TipSense& sense);

  /// Precomputes the hand's motion without forces. Call it before the first tick. Copies share the
  /// result, which halves the cost of many explorations along one path; results are unchanged.
  void precompute();

  /// The tip's velocity at the end of the last tick, along the plane relative to the motion of the
  /// same hand and device without forces, because people know how a device feels in free air.
  /// \pre set_sense
  [[nodiscard]] Vec3 yielding_velocity_mm_s() const noexcept { return yielding_mm_s_; }

 private:
  /// The arm's intention in a tick.
  struct Intention {
    PathPoint target;
    double push_n = 0.0;
  };
  /// The intention, and the tip's velocity after the tick without forces.
  struct FreeTick {
    Intention intention;
    Vec2 tip_mm_s;
  };
  [[nodiscard]] Intention intention_at(std::int64_t tick, std::size_t& stroke) const noexcept;
  [[nodiscard]] HeldDevice make_free_device() const;
  void update_sense(TipSense& sense, Vec3 tip_mm, Vec3 force_n, const Intention& intention,
                    const FreeTick* free_tick) noexcept;

  HandOptions options_;
  ExplorationPath path_;
  HeldDevice held_;
  double max_force_n_;  ///< the smaller of the hand's and the device's
  DeviceModel device_;
  TipSense* sense_ = nullptr;
  Vec3 yielding_mm_s_;
  std::optional<HeldDevice> free_device_;  ///< with a TipSense: the motion without forces
  /// Replaces `free_device_`; null: not precomputed.
  std::shared_ptr<const std::vector<FreeTick>> precomputed_;
  std::size_t stroke_ = 0;
  std::int64_t tick_ = 0;
  std::int64_t last_tick_;
};

// Inlined into the servo's loop, because every simulated tick uses them.

inline PathPoint ExplorationPath::at(double time_s, std::size_t& stroke) const noexcept {
  while (stroke + 1 < strokes_.size() && time_s >= strokes_[stroke].end_s()) ++stroke;
  const Stroke& s = strokes_[stroke];
  const double elapsed_s = time_s - s.start_s;
  const double remaining_s = s.end_s() - time_s;
  const double steady_s = std::clamp(elapsed_s - kRampS, 0.0, s.steady_s - kRampS);
  // In the steady part, speeding up has covered half a ramp, and slowing down has not begun.
  const bool is_steady = elapsed_s >= kRampS && remaining_s >= kRampS;
  const Ramps ramps = is_steady ? Ramps{0.5 * kRampS, 1.0} : ramps_at(elapsed_s, remaining_s);
  const double speed_mm_s = s.speed_mm_s * ramps.speed_share;
  return {s.start_mm + (s.speed_mm_s * (steady_s + ramps.distance_s)) * s.direction,
          speed_mm_s * s.direction};
}

inline SimulatedHand::Intention SimulatedHand::intention_at(std::int64_t tick,
                                                            std::size_t& stroke) const noexcept {
  const double time_s = static_cast<double>(tick) * kServoTickS;
  double share = 1.0;  // of the push: from 0 to 1, with zero slope at both ends
  if (time_s < kPushBuildUpS) {
    const double u = time_s / kPushBuildUpS;
    share = u * u * (3.0 - 2.0 * u);
  }
  return {path_.at(time_s, stroke), options_.push_n * share};
}

inline DeviceStatus SimulatedHand::read(DeviceSample& sample) noexcept {
  sample = {copy_by_component(held_.device.read_position_mm()),
            copy_by_component(held_.device.read_velocity_mm_s()),
            static_cast<std::uint64_t>(tick_) + 1};
  return tick_ < last_tick_ ? DeviceStatus::ok : DeviceStatus::stopped;
}

inline DeviceStatus SimulatedHand::write(Vec3 force_n) noexcept {
  const FreeTick* free_tick = nullptr;
  if (precomputed_ != nullptr) free_tick = &(*precomputed_)[std::min(tick_, last_tick_)];
  const Intention intention =
      free_tick != nullptr ? free_tick->intention : intention_at(tick_, stroke_);
  const Vec3 tip_mm = copy_by_component(held_.device.true_position_mm());
  held_.tick(force_n, intention.target, intention.push_n);
  ++tick_;
  if (sense_ != nullptr) update_sense(*sense_, tip_mm, force_n, intention, free_tick);
  return DeviceStatus::ok;
}

inline void SimulatedHand::update_sense(TipSense& sense, Vec3 tip_mm, Vec3 force_n,
                                        const Intention& intention,
                                        const FreeTick* free_tick) noexcept {
  Vec2 free_mm_s;
  if (free_tick != nullptr) {
    free_mm_s = free_tick->tip_mm_s;
  } else {
    static_cast<void>(free_device_->tick({}, intention.target, intention.push_n));
    const Vec3& tip_mm_s = free_device_->device.true_velocity_mm_s();
    free_mm_s = {tip_mm_s.x, tip_mm_s.y};
  }
  const Vec3 before_mm_s = copy_by_component(yielding_mm_s_);
  yielding_mm_s_ = held_.device.true_velocity_mm_s() - Vec3{free_mm_s.x, free_mm_s.y, 0.0};
  // mm/s in a tick of 1 ms are m/s^2.
  static_assert(kServoTick == std::chrono::milliseconds(1));
  sense.feel(tip_mm, force_n, yielding_mm_s_ - before_mm_s);
}

}  // namespace touchtrial::device

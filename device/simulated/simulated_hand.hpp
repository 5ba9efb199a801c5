/// \file A simulated device and hand: the hand follows a path of straight lateral strokes between
/// random points, pushes, and yields to forces.
#pragma once

#include "core/plane_geometry.hpp"
#include "core/random.hpp"
#include "core/vec.hpp"
#include "device/haptic_device.hpp"
#include "device/model/device_model.hpp"
#include "device/simulated/hand_on_tip.hpp"

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
  double margin_mm = 8.0;       ///< kept from the plane's edge, >= 0; at most a fifth of a side
  double duration_s = 10.0;     ///< > 0
};

/// Strokes end to end. Each starts and ends at rest, speeds up and slows down smoothly (continuous
/// acceleration), and keeps its speed in between. End points are uniform within the margin and at
/// least half the shorter side apart, so that direction and offset differ with every stroke; speeds
/// are uniform in the range. Strokes are slower on a plane too short for the speed.
class ExplorationPath {
 public:
  /// The time in which a stroke reaches its speed, and that in which it comes to rest.
  static constexpr double kRampS = 0.08;

  /// \throws std::invalid_argument if the plane has no area or an option is out of range
  ExplorationPath(const PlaneGeometry& plane, const ExplorationOptions& options,
                  RandomStream& random);

  /// \param time_s  >= 0, never earlier than in the last call; after the last stroke the path rests
  ///   at its end
  /// \param stroke  the place of the search, which the caller keeps from call to call; 0 at first
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
  [[nodiscard]] static Stroke stroke_between(Vec2 from_mm, Vec2 to_mm, double start_s,
                                             double speed_mm_s) noexcept;

  std::vector<Stroke> strokes_;
};

/// \return how records name a simulated hand's device: "simulated", with a model's name unless it is
///   ideal
[[nodiscard]] std::string words_of_simulated(const DeviceModel& held);

/// What a simulated hand notices of its own tip.
class TipSense {
 public:
  virtual ~TipSense() = default;
  /// One tick, on the thread of the servo. Must not block, allocate or throw.
  /// \param force_n  commanded for the tick
  /// \param acceleration_m_s2  of the tip, less what the hand does by itself
  virtual void feel(Vec3 position_mm, Vec3 force_n, Vec3 acceleration_m_s2) noexcept = 0;
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

  /// The hand begins above the path's first point.
  /// \param device  whose mass adds to the hand's; in the plane frame, its workspace is not in use
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
  /// \param sense  told of every tick; must outlive the hand
  void feel_by(TipSense& sense);

  /// Works out, before the first tick, the hand's whole way without forces. Copies made from then
  /// on share it, so that many explorations along one path cost half as much; nothing else changes.
  void foresee();

  /// How forces move the tip off the way that the same hand would take with the same device and no
  /// forces: people know how a device feels in the air. Across the plane, its velocity itself. At
  /// the end of the last tick.
  /// \pre feel_by
  [[nodiscard]] Vec3 yielding_velocity_mm_s() const noexcept { return yielding_mm_s_; }

 private:
  /// What the arm intends in a tick.
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

  HandOptions options_;
  ExplorationPath path_;
  HeldDevice held_;
  double max_force_n_;  ///< of hand and device, the smaller one
  DeviceModel device_;
  TipSense* sense_ = nullptr;
  Vec3 yielding_mm_s_;
  std::optional<HeldDevice> unforced_;  ///< where somebody feels: moves as if nothing pushed
  std::shared_ptr<const std::vector<FreeTick>> foreseen_;  ///< in place of it; null: not foreseen
  std::size_t stroke_ = 0;
  std::int64_t tick_ = 0;
  std::int64_t last_tick_;
};

}  // namespace touchtrial::device

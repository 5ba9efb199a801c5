/// \file A simulated device and hand: the hand follows a path, pushes, and yields to forces.
#pragma once

#include "device/haptic_device.hpp"
#include "device/simulated/exploration_path.hpp"

#include <chrono>
#include <cstdint>

namespace touchtrial::device {

/// A hand on a stylus, as a point mass. Defaults: a light pen grip, near critical damping.
struct HandOptions {
  double mass_kg = 0.1;                    ///< of hand and stylus as felt at the tip, > 0
  double arm_stiffness_n_per_mm = 0.2;     ///< spring towards the path, along the plane, >= 0
  double arm_damping_n_s_per_mm = 0.008;   ///< of motion against the path's, >= 0
  double push_n = 0.7;                     ///< steady push on the plane, >= 0
  double push_damping_n_s_per_mm = 0.008;  ///< of motion across the plane, >= 0
  double start_height_mm = 15.0;           ///< above the plane, >= 0
  double explore_s = 10.0;                 ///< after which the hand stops, > 0
  double max_force_n = 3.3;                ///< of the device that it holds, > 0
};

/// The driver "simulated". Along the plane a spring and a damper pull the mass towards the path. A
/// push, which builds up smoothly while the hand comes down from above, presses it on the plane.
/// The servo's forces move it. Semi-implicit Euler (damping fully implicit) at the servo's rate, in
/// virtual time: each `write` is one tick. The motion depends on the options, the path and the
/// forces alone. Not thread-safe.
class SimulatedHand final : public HapticDevice {
 public:
  /// The time in which the push builds up, s.
  static constexpr double kPushBuildUpS = 0.3;

  /// The hand begins above the path's first point.
  /// \throws std::invalid_argument if an option is out of range
  SimulatedHand(const HandOptions& options, ExplorationPath path);

  [[nodiscard]] DeviceInfo info() const override;
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// Does nothing: a force lasts for its own tick only.
  void halt() noexcept override {}
  void rearm() noexcept override {}

  /// \return the virtual time since the hand was made
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept;

 private:
  HandOptions options_;
  ExplorationPath path_;
  std::size_t stroke_ = 0;
  std::int64_t tick_ = 0;
  std::int64_t last_tick_;
  DeviceSample state_;
};

}  // namespace touchtrial::device

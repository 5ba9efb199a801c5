/// \file Models of a hand that holds and pushes a tip: a point mass, or a published stylus grip.
///   Source of the equations: docs/devices/hands.md.
#pragma once

#include "core/vec.hpp"
#include "device/model/device_model.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <string_view>

namespace touchtrial::device {

/// The model of a hand.
enum class HandKind {
  point_mass,   ///< a mass on a spring and a damper: a light pen grip, near critical damping
  stylus_grip,  ///< Fu and Cavusoglu 2012: fingers on a second mass, held by an arm
};

/// \return the name in files: "point_mass" or "stylus_grip"
[[nodiscard]] std::string_view name_of(HandKind model) noexcept;

/// Factors of one person's hand relative to the model, on all axes.
struct HandFactors {
  double stiffness = 1.0;  ///< >= 0
  double damping = 1.0;    ///< >= 0
  double mass = 1.0;       ///< > 0
};

/// Position and velocity of the path at one time.
struct PathPoint {
  Vec2 position_mm;
  Vec2 velocity_mm_s;
};

/// A hand on a stylus. Mass, arm and damping apply only to the point mass; the grip uses published
/// values.
struct HandOptions {
  double mass_kg = 0.1;                    ///< of hand and stylus as felt at the tip, > 0
  double arm_stiffness_n_per_mm = 0.2;     ///< spring towards the path, along the plane, >= 0
  double arm_damping_n_s_per_mm = 0.008;   ///< of motion relative to the path, >= 0
  double push_n = 0.7;                     ///< steady push on the plane, >= 0
  double push_damping_n_s_per_mm = 0.008;  ///< of motion across the plane, >= 0
  double start_height_mm = 15.0;           ///< above the plane, >= 0
  double explore_s = 10.0;                 ///< duration of exploration, > 0
  double max_force_n = 3.3;                ///< of the held device, > 0; a model may lower it
  HandKind model = HandKind::point_mass;
  HandFactors factors{};
};

/// The hand between an arm's intention, which moves along a path and pushes, and the tip of a
/// device, tick by tick. A tick does not allocate, lock or throw. Not thread-safe.
class HandOnTip {
 public:
  /// Starts at rest at the origin.
  /// \param device  the held device. The grip has no mass at the tip, so it adds mass to a device
  ///   lighter than DeviceDynamics::kMinMassKg.
  /// \param tick_s  as for DeviceDynamics
  /// \throws std::invalid_argument if an option is out of range
  HandOnTip(const HandOptions& options, const DeviceModel& device, double tick_s);

  /// Places the hand on a tip that is at rest at this position.
  void place(Vec3 tip_mm) noexcept;

  /// \param tip_mm, tip_mm_s  true position and velocity of the tip, in the plane frame
  /// \param intention  the arm's target, along the plane
  /// \param push_n  towards the plane
  /// \return the hand's action on the tip in the next tick
  [[nodiscard]] DeviceDynamics::TipLoad hold(const Vec3& tip_mm, const Vec3& tip_mm_s,
                                             const PathPoint& intention, double push_n) noexcept {
    return is_grip_ ? grip(tip_mm, tip_mm_s, intention, push_n)
                    : hold_as_point(tip_mm, intention, push_n);
  }
  [[nodiscard]] bool is_point() const noexcept { return !is_grip_; }
  /// `hold` of a point mass, which needs no `follow`.
  [[nodiscard]] DeviceDynamics::TipLoad hold_as_point(Vec3 tip_mm, const PathPoint& intention,
                                                      double push_n) const noexcept {
    const double damping = options_.arm_damping_n_s_per_mm;
    const Vec2 pull_n =
        options_.arm_stiffness_n_per_mm * (intention.position_mm - Vec2{tip_mm.x, tip_mm.y}) +
        damping * intention.velocity_mm_s;
    return {{pull_n.x, pull_n.y, -push_n},
            tip_kg_,
            {damping, damping, options_.push_damping_n_s_per_mm}};
  }
  /// Ends the tick.
  /// \param tip_mm_s  the tip's velocity after the tick
  void follow(const Vec3& tip_mm_s) noexcept {
    if (is_grip_) follow_grip(tip_mm_s);
  }

  /// \return the position of the hand's mass behind the grip; the point mass has none
  [[nodiscard]] Vec3 position_mm() const noexcept;
  [[nodiscard]] Vec3 velocity_mm_s() const noexcept;

  /// \param axis  0 .. 2: x, y, z of the plane frame
  /// \param s  complex frequency, 1/s
  /// \return force on the tip per displacement of the tip with a constant intention, N/mm,
  ///   including the hand's mass at the tip
  [[nodiscard]] std::complex<double> dynamic_stiffness(std::size_t axis,
                                                       std::complex<double> s) const noexcept;

 private:
  /// One axis of the grip: tip, fingers (spring and damper), mass, arm (spring and damper).
  struct Axis {
    double mass_kg, finger_n_per_mm, finger_n_s_per_mm, arm_n_per_mm, arm_n_s_per_mm;
    /// N s/mm: coefficients of the velocities before and after a tick.
    double finger_before, finger_after, arm_before, arm_after;
    double inertia;          ///< N s/mm: mass divided by the tick
    double share;            ///< of the tip's velocity that the mass adopts within a tick
    double free_mm_s = 0.0;  ///< the mass's velocity after the tick if the tip were then at rest
    double position_mm = 0.0;
    double velocity_mm_s = 0.0;
  };
  struct Pull {
    double force_n, damping_n_s_per_mm;
  };
  [[nodiscard]] Axis grip_axis(std::size_t axis) const noexcept;
  [[nodiscard]] DeviceDynamics::TipLoad grip(const Vec3& tip_mm, const Vec3& tip_mm_s,
                                             const PathPoint& intention, double push_n) noexcept;
  void follow_grip(const Vec3& tip_mm_s) noexcept;
  [[nodiscard]] static Pull pull(Axis& axis, double tip_mm, double tip_mm_s, double target_mm,
                                 double drive_n) noexcept;

  HandOptions options_;  ///< with the factors in the point mass's parameters
  double tick_s_;
  bool is_grip_;
  bool holds_force_;            ///< whether the device holds a force over the tick
  double tip_kg_;               ///< the hand's mass at the tip
  std::array<Axis, 3> axes_{};  ///< of the grip
};

/// A device in a hand, tick by tick.
struct HeldDevice {
  DeviceDynamics device;
  HandOnTip hand;

  /// \throws std::invalid_argument as DeviceDynamics and HandOnTip
  HeldDevice(const HandOptions& options, const DeviceModel& model, double tick_s = 0.001)
      : device(model, tick_s), hand(options, model, tick_s) {}

  /// Places tip and hand at this position, at rest.
  void place(Vec3 tip_mm) noexcept {
    device.place(tip_mm);
    hand.place(tip_mm);
  }
  /// \return the hand's action on the tip
  DeviceDynamics::TipLoad tick(Vec3 commanded_n, const PathPoint& intention,
                               double push_n) noexcept {
    // The common case has its own branch, so that the state stays in registers.
    if (device.is_plain() && hand.is_point()) {
      const DeviceDynamics::TipLoad load =
          hand.hold_as_point(device.true_position_mm(), intention, push_n);
      device.tick_plain(commanded_n, load);
      return load;
    }
    const DeviceDynamics::TipLoad load =
        hand.hold(device.true_position_mm(), device.true_velocity_mm_s(), intention, push_n);
    device.tick(commanded_n, load);
    hand.follow(device.true_velocity_mm_s());
    return load;
  }
};

}  // namespace touchtrial::device

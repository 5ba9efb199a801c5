#include "device/drivers/simulated/hand_on_tip.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::device {
namespace {

constexpr double kHandMPerMm = 0.001;

/// Fu and Cavusoglu 2012, means over subjects, 0.6 to 30 Hz; N/m and N s/m.
struct PublishedGrip {
  double mass_kg, k1, b1, k2, b2;
};
/// x and y along a horizontal plane, z out of it: left-right, fore-aft and up-down in the paper.
constexpr std::array<PublishedGrip, 3> kPublishedGrip{{{0.218, 380.0, 1.84, 79.0, 4.6},
                                                       {0.204, 770.0, 0.78, 272.0, 18.0},
                                                       {0.269, 552.0, 3.61, 105.0, 6.4}}};

void check_hand(const HandOptions& o) {
  const bool are_positive = o.mass_kg > 0.0 && o.explore_s > 0.0 && o.max_force_n > 0.0;
  const bool are_not_negative = o.arm_stiffness_n_per_mm >= 0.0 &&
                                o.arm_damping_n_s_per_mm >= 0.0 && o.push_n >= 0.0 &&
                                o.push_damping_n_s_per_mm >= 0.0 && o.start_height_mm >= 0.0;
  const bool factors_ok =
      o.factors.mass > 0.0 && o.factors.stiffness >= 0.0 && o.factors.damping >= 0.0;
  if (!are_positive || !are_not_negative || !factors_ok) {
    throw std::invalid_argument("SimulatedHand: an option is out of range");
  }
}

/// \return the options with the person's factors in the point mass's parameters
HandOptions apply_hand_factors(HandOptions o) {
  check_hand(o);
  o.mass_kg *= o.factors.mass;
  o.arm_stiffness_n_per_mm *= o.factors.stiffness;
  o.arm_damping_n_s_per_mm *= o.factors.damping;
  o.push_damping_n_s_per_mm *= o.factors.damping;
  return o;
}

}  // namespace

std::string_view name_of(HandKind model) noexcept {
  return model == HandKind::stylus_grip ? "stylus_grip" : "point_mass";
}

HandOnTip::HandOnTip(const HandOptions& options, const DeviceModel& device, double tick_s)
    : options_(apply_hand_factors(options)),
      tick_s_(tick_s),
      is_grip_(options.model == HandKind::stylus_grip),
      holds_force_(device.zero_order_hold || device.structure.stiffness_n_per_mm > 0.0),
      tip_kg_(is_grip_ ? std::max(0.0, DeviceDynamics::kMinMassKg - device.mass_kg)
                       : options_.mass_kg) {
  if (!is_grip_) return;
  for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i] = grip_axis(i);
}

/// Springs and dampers by the trapezium rule. A device that does not hold its force has velocities
/// at mid-tick, so the spring uses the mean of three positions instead of two. Neither rule damps
/// or excites motion, at any stiffness.
HandOnTip::Axis HandOnTip::grip_axis(std::size_t axis) const noexcept {
  const PublishedGrip& grip = kPublishedGrip[axis];
  const HandFactors& factors = options_.factors;
  Axis a{};
  a.mass_kg = factors.mass * grip.mass_kg;
  a.finger_n_per_mm = factors.stiffness * kHandMPerMm * grip.k1;
  a.finger_n_s_per_mm = factors.damping * kHandMPerMm * grip.b1;
  a.arm_n_per_mm = axis == 2 ? 0.0 : factors.stiffness * kHandMPerMm * grip.k2;
  a.arm_n_s_per_mm = factors.damping * kHandMPerMm * grip.b2;
  const double sign = holds_force_ ? 1.0 : -1.0;
  const double finger = 0.25 * tick_s_ * a.finger_n_per_mm;
  const double arm = 0.25 * tick_s_ * a.arm_n_per_mm;
  a.finger_before = 0.5 * a.finger_n_s_per_mm + sign * finger;
  a.finger_after = 0.5 * a.finger_n_s_per_mm + finger;
  a.arm_before = 0.5 * a.arm_n_s_per_mm + sign * arm;
  a.arm_after = 0.5 * a.arm_n_s_per_mm + arm;
  a.inertia = kHandMPerMm * a.mass_kg / tick_s_;
  a.share = a.finger_after / (a.inertia + a.finger_after + a.arm_after);
  return a;
}

void HandOnTip::place(Vec3 tip_mm) noexcept {
  const std::array<double, 3> coordinates{tip_mm.x, tip_mm.y, tip_mm.z};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].position_mm = coordinates[i];
    axes_[i].velocity_mm_s = 0.0;
  }
}

/// The mass's velocity after the tick is linear in the tip's, so the hand acts on the tip as a
/// force and a damping, which DeviceDynamics accepts.
/// \param drive_n  the arm's push, and the force of its damper from the intention's velocity
HandOnTip::Pull HandOnTip::pull(Axis& a, double tip_mm, double tip_mm_s, double target_mm,
                                double drive_n) noexcept {
  const double fingers_n =
      a.finger_n_per_mm * (a.position_mm - tip_mm) + a.finger_before * (a.velocity_mm_s - tip_mm_s);
  const double arm_n =
      a.arm_n_per_mm * (target_mm - a.position_mm) - a.arm_before * a.velocity_mm_s + drive_n;
  a.free_mm_s = (a.inertia * a.velocity_mm_s - fingers_n + arm_n) /
                (a.inertia + a.finger_after + a.arm_after);
  return {fingers_n + a.finger_after * a.free_mm_s, a.finger_after * (1.0 - a.share)};
}

DeviceDynamics::TipLoad HandOnTip::grip(const Vec3& tip_mm, const Vec3& tip_mm_s,
                                        const PathPoint& intention, double push_n) noexcept {
  const double lead_s = holds_force_ ? 0.5 * tick_s_ : 0.0;
  const Vec2 target_mm = intention.position_mm + lead_s * intention.velocity_mm_s;
  const Vec2 path_mm_s = intention.velocity_mm_s;
  const Pull x =
      pull(axes_[0], tip_mm.x, tip_mm_s.x, target_mm.x, axes_[0].arm_n_s_per_mm * path_mm_s.x);
  const Pull y =
      pull(axes_[1], tip_mm.y, tip_mm_s.y, target_mm.y, axes_[1].arm_n_s_per_mm * path_mm_s.y);
  const Pull z = pull(axes_[2], tip_mm.z, tip_mm_s.z, 0.0, -push_n);
  return {{x.force_n, y.force_n, z.force_n},
          tip_kg_,
          {x.damping_n_s_per_mm, y.damping_n_s_per_mm, z.damping_n_s_per_mm}};
}

void HandOnTip::follow_grip(const Vec3& tip_mm_s) noexcept {
  const std::array<double, 3> tip{tip_mm_s.x, tip_mm_s.y, tip_mm_s.z};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& a = axes_[i];
    const double after_mm_s = a.free_mm_s + a.share * tip[i];
    a.position_mm += tick_s_ * (holds_force_ ? 0.5 * (a.velocity_mm_s + after_mm_s) : after_mm_s);
    a.velocity_mm_s = after_mm_s;
  }
}

Vec3 HandOnTip::position_mm() const noexcept {
  return {axes_[0].position_mm, axes_[1].position_mm, axes_[2].position_mm};
}

Vec3 HandOnTip::velocity_mm_s() const noexcept {
  return {axes_[0].velocity_mm_s, axes_[1].velocity_mm_s, axes_[2].velocity_mm_s};
}

std::complex<double> HandOnTip::dynamic_stiffness(std::size_t axis,
                                                  std::complex<double> s) const noexcept {
  const std::complex<double> tip_mass = kHandMPerMm * tip_kg_ * s * s;
  if (!is_grip_) {
    return axis == 2
               ? tip_mass + options_.push_damping_n_s_per_mm * s
               : tip_mass + options_.arm_damping_n_s_per_mm * s + options_.arm_stiffness_n_per_mm;
  }
  const Axis& a = axes_[axis];
  const std::complex<double> fingers = a.finger_n_per_mm + a.finger_n_s_per_mm * s;
  const std::complex<double> mass_and_arm =
      kHandMPerMm * a.mass_kg * s * s + a.arm_n_s_per_mm * s + a.arm_n_per_mm;
  return tip_mass + fingers * mass_and_arm / (fingers + mass_and_arm);
}

}  // namespace touchtrial::device

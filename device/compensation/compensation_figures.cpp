#include "device/compensation/compensation_figures.hpp"

#include "device/compensation/force_shaper.hpp"
#include "device/servo/servo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

namespace touchtrial::device {
namespace {

constexpr double kMmPerMetre = 1000.0;
constexpr double kStrokeMmS = 100.0;

/// Multiples of 0.5 Hz, so that two seconds are whole periods.
constexpr std::array kFrequenciesHz{10.0, 12.5, 16.0,  20.0,  25.0,  31.5,  40.0,  50.0,
                                    63.0, 80.0, 100.0, 125.0, 160.0, 200.0, 250.0, 320.0};
constexpr int kCountedTicks = 2000;
constexpr int kSettledTicks = 2000;
constexpr double kSineN = 0.05;  ///< as a texture's force

/// A device in a hand, behind a shaper or none.
struct Rig {
  HeldDevice held;
  std::optional<ForceShaper> shaper;

  DeviceDynamics::Outside tick(Vec3 force_n, const PathPoint& intention, double push_n) {
    return held.tick(shaper ? shaper->shaped(force_n) : force_n, intention, push_n);
  }
};

PathPoint on_stroke(int tick) {
  return {{kStrokeMmS * kServoTickS * tick, 0.0}, {kStrokeMmS, 0.0}};
}

/// Amplitudes per newton of a sine along the stroke.
struct Amplitudes {
  double acceleration_m_s2 = 0.0;
  double motors_n = 0.0;
};

Amplitudes amplitudes_under_sine(Rig rig, double frequency_hz) {
  std::complex<double> acceleration;
  std::complex<double> motors;
  double before_mm_s = 0.0;
  for (int i = 0; i < kSettledTicks + kCountedTicks; ++i) {
    const double phase = 2.0 * std::numbers::pi * frequency_hz * kServoTickS * i;
    rig.tick({kSineN * std::sin(phase), 0.0, 0.0}, on_stroke(i), 0.0);
    const double after_mm_s = rig.held.device.true_velocity_mm_s().x;
    if (i >= kSettledTicks) {
      const std::complex<double> turned = std::polar(2.0 / (kSineN * kCountedTicks), -phase);
      acceleration += (after_mm_s - before_mm_s) / (kServoTickS * kMmPerMetre) * turned;
      motors += rig.held.device.delivered_force_n().x * turned;
    }
    before_mm_s = after_mm_s;
  }
  return {std::abs(acceleration), std::abs(motors)};
}

double wall_n(const Rig& rig, double stiffness_n_per_mm) {
  return stiffness_n_per_mm * std::max(0.0, -rig.held.device.read_position_mm().z);
}

/// Adds up the spread of a quantity about its mean.
struct Spread {
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  void see(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double deviation() const {
    const double mean = sum / count;
    return std::sqrt(std::max(0.0, squares / count - mean * mean));
  }
};

/// One tick of a stroke on the wall with a push that wavers, as a hand's does, so that the tip
/// crosses encoder steps.
/// \return the force of the hand on the tip, out of the plane
double stroke_on_wall(Rig& rig, int tick, const HandOptions& hand) {
  constexpr double kWaverShare = 0.3;
  constexpr double kWaverHz = 0.7;
  const double push_n =
      hand.push_n *
      (1.0 + kWaverShare * std::sin(2.0 * std::numbers::pi * kWaverHz * kServoTickS * tick));
  const double before_mm_s = rig.held.device.true_velocity_mm_s().z;
  const DeviceDynamics::Outside outside =
      rig.tick({0.0, 0.0, wall_n(rig, kNoiseWallNPerMm)}, on_stroke(tick), push_n);
  const double after_mm_s = rig.held.device.true_velocity_mm_s().z;
  // The point mass is the hand's; what the grip adds to a light device is the device's.
  const double hand_kg = hand.model == HandKind::point_mass ? outside.mass_kg : 0.0;
  return outside.force_n.z - outside.damping_n_s_per_mm.z * after_mm_s -
         hand_kg * (after_mm_s - before_mm_s) / (kServoTickS * kMmPerMetre);
}

/// Compares two strokes that differ by the encoders' steps alone.
void measure_noise(Rig stepped, Rig smooth, const HandOptions& hand, WallFigures& figures) {
  constexpr int kBegins = 2000;
  constexpr int kEnds = 12'000;
  Spread at_motors;
  Spread at_tip;
  for (int i = 0; i < kEnds; ++i) {
    const double difference_n = stroke_on_wall(stepped, i, hand) - stroke_on_wall(smooth, i, hand);
    if (i < kBegins) continue;
    at_tip.see(difference_n);
    at_motors.see(stepped.held.device.delivered_force_n().z -
                  smooth.held.device.delivered_force_n().z);
  }
  figures.noise_motors_n = at_motors.deviation();
  figures.noise_tip_n = at_tip.deviation();
}

/// Strokes on a wall, where friction hardly holds the tip any more, kicks it, and looks whether its
/// height comes to rest again.
/// \param step_mm  of the encoders: a motion of a part of one is rest
bool settles(Rig rig, double stiffness_n_per_mm, double push_n, double step_mm) {
  constexpr int kKick = 1000;
  constexpr int kKickTicks = 10;
  constexpr int kLate = 3500;
  constexpr int kEnds = 4000;
  constexpr double kKickN = 1.0;
  constexpr double kRestShare = 0.1;
  constexpr double kRestSteps = 0.25;
  Spread after_kick;
  Spread late;
  for (int i = 0; i < kEnds; ++i) {
    const bool is_kicked = i >= kKick && i < kKick + kKickTicks;
    rig.tick({0.0, 0.0, wall_n(rig, stiffness_n_per_mm)}, on_stroke(i),
             push_n + (is_kicked ? kKickN : 0.0));
    const double at_mm = rig.held.device.true_position_mm().z;
    if (i >= kKick && i < kKick + kEnds - kLate) after_kick.see(at_mm);
    if (i >= kLate) late.see(at_mm);
  }
  return late.deviation() <= std::max(kRestShare * after_kick.deviation(), kRestSteps * step_mm);
}

double stiffest_wall_n_per_mm(const Rig& rig, double push_n, double step_mm) {
  double stiffest = 0.0;
  for (double tried = kSoftestWallNPerMm; tried <= kStiffestWallNPerMm; tried *= kWallStep) {
    if (!settles(rig, tried, push_n, step_mm)) break;
    stiffest = tried;
  }
  return stiffest;
}

}  // namespace

CompensationFigures measure_compensation(const DeviceModel& device, const HandOptions& hand,
                                         double most_gain_db) {
  const ForceShaper shaper(device, hand, most_gain_db);
  DeviceModel smooth_device = device;
  smooth_device.position_step_mm = 0.0;
  const HeldDevice held(hand, device);
  const HeldDevice smooth(hand, smooth_device);
  const Rig ideal{HeldDevice(hand, device_model("ideal")), {}};
  CompensationFigures figures;
  for (const double hz : kFrequenciesHz) {
    const Amplitudes without = amplitudes_under_sine({held, {}}, hz);
    const Amplitudes with = amplitudes_under_sine({held, shaper}, hz);
    figures.responses.push_back({hz, amplitudes_under_sine(ideal, hz).acceleration_m_s2,
                                 without.acceleration_m_s2, with.acceleration_m_s2,
                                 20.0 * std::log10(with.motors_n / without.motors_n)});
  }
  measure_noise({held, {}}, {smooth, {}}, hand, figures.without);
  measure_noise({held, shaper}, {smooth, shaper}, hand, figures.with);
  figures.without.stiffest_n_per_mm =
      stiffest_wall_n_per_mm({held, {}}, hand.push_n, device.position_step_mm);
  figures.with.stiffest_n_per_mm =
      stiffest_wall_n_per_mm({held, shaper}, hand.push_n, device.position_step_mm);
  return figures;
}

}  // namespace touchtrial::device

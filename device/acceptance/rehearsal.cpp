#include "device/acceptance/rehearsal.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace touchtrial::device {
namespace {

/// The simulated person's weight and motions.
constexpr double kRehearsedWeightN = 1.0;
constexpr double kStrokeMm = 8.0;  ///< slow motion to either side
constexpr double kStrokePeriodS = 6.0;
constexpr double kCarriedMm = 20.0;
constexpr double kLiftDelayS = 1.0;
constexpr double kPressN = 0.7;
constexpr double kReleaseS = 1.8;  ///< within the two seconds allowed by the prompts

double seconds_of(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

Vec3 equal_axes(double value) {
  return {value, value, value};
}

}  // namespace

Rehearsal::Rehearsal(const DeviceModel& model)
    : device_(model), middle_mm_(device_.dynamics().true_position_mm()) {
  device_.set_hand(
      [this](double time_s, Vec3 position_mm, Vec3) { return hand_load(time_s, position_mm); });
}

ServoReport Rehearsal::run(const std::string& /*name*/, Measurement& measurement) {
  device_.place(middle_mm_);
  run_start_s_ = seconds_of(device_.now());
  ServoOptions options;
  options.limit_ticks = std::llround(measurement.seconds() * kServoRateHz) + 1;
  options.limits = limits();
  return run_servo_in_virtual_time(device_, measurement, measurement, options);
}

Consent Rehearsal::ready(const Prompt& prompt) {
  grip_ = prompt.grip;
  axis_ = prompt.axis;
  return Consent::go;
}

std::optional<double> Rehearsal::weight_n(DeviceAxis /*axis*/, double /*min_n*/, double max_n) {
  weight_n_ = std::min(kRehearsedWeightN, max_n);
  return weight_n_;
}

std::optional<double> Rehearsal::temperature_c(const std::string& /*question*/) {
  return std::nullopt;
}

std::string Rehearsal::ask_observation(const std::string& /*question*/) {
  return "";
}

DeviceDynamics::TipLoad Rehearsal::release_load(double time_s, Vec3 to_middle_mm) const {
  const double share = std::max(0.0, 1.0 - (time_s - run_start_s_) / kReleaseS);
  return {(share * 0.5) * to_middle_mm, 0.0, equal_axes(share * 0.02)};
}

DeviceDynamics::TipLoad Rehearsal::hand_load(double time_s, Vec3 position_mm) const {
  const Vec3 gravity_support_n = {0.0, device_.model().planted_faults.gravity_n, 0.0};
  const Vec3 to_middle_mm = middle_mm_ - position_mm;
  switch (grip_) {
    case Grip::lying:
    case Grip::guarding:
      return {1.0 * to_middle_mm + gravity_support_n, 0.2, equal_axes(0.03)};
    case Grip::moving: {
      const double phase = 2.0 * std::acos(-1.0) * (time_s - run_start_s_) / kStrokePeriodS;
      const Vec3 offset_mm = {kStrokeMm * std::sin(phase), kStrokeMm * std::sin(1.2 * phase),
                              kStrokeMm * std::sin(1.5 * phase)};
      return {0.5 * (to_middle_mm + offset_mm) + gravity_support_n, 0.1, equal_axes(0.01)};
    }
    case Grip::carrying: {
      const double share = std::clamp(time_s - run_start_s_ - kLiftDelayS, 0.0, 1.0);
      return {0.5 * (to_middle_mm + (share * kCarriedMm) * direction_of(axis_)) + gravity_support_n,
              0.1, equal_axes(0.01)};
    }
    case Grip::holding:
      return {0.05 * to_middle_mm + gravity_support_n, 0.05, equal_axes(0.003)};
    case Grip::free:
      return release_load(time_s, to_middle_mm);
    case Grip::loaded: {
      // The weight pulls down along y. Over a pulley, it pulls to the right along x, or towards
      // the person along z.
      const double sign = axis_ == DeviceAxis::y ? -1.0 : 1.0;
      const DeviceDynamics::TipLoad hand = release_load(time_s, to_middle_mm);
      return {hand.force_n + sign * weight_n_ * direction_of(axis_),
              weight_n_ / kStandardGravityMS2, hand.damping_n_s_per_mm};
    }
    case Grip::pressing:
      break;
  }
  return {gravity_support_n + Vec3{0.1 * to_middle_mm.x, -kPressN, 0.1 * to_middle_mm.z},
          0.1,
          {0.004, 0.008, 0.004}};
}

Acceptance rehearse_acceptance(const DeviceModel& model, const AcceptanceOptions& options) {
  Rehearsal rehearsal(model);
  Acceptance acceptance = accept_device(rehearsal, rehearsal, options);
  acceptance.certificate.emulated = model.name;
  return acceptance;
}

}  // namespace touchtrial::device

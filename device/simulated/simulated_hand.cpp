#include "device/simulated/simulated_hand.hpp"

#include "device/drivers.hpp"
#include "device/servo/servo.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace touchtrial::device {
namespace {

constexpr double kMmPerM = 1000.0;
/// The plane and the time of a hand that is opened by name; nobody watches it for longer.
constexpr PlaneGeometry kNamedPlane{0.2, 500, 500};
constexpr double kNamedExploreS = 8.0 * 3600.0;

void check(const HandOptions& o) {
  const bool positive = o.mass_kg > 0.0 && o.explore_s > 0.0 && o.max_force_n > 0.0;
  const bool not_negative = o.arm_stiffness_n_per_mm >= 0.0 && o.arm_damping_n_s_per_mm >= 0.0 &&
                            o.push_n >= 0.0 && o.push_damping_n_s_per_mm >= 0.0 &&
                            o.start_height_mm >= 0.0;
  if (!positive || !not_negative) {
    throw std::invalid_argument("SimulatedHand: an option is out of range");
  }
}

/// \return the share of the push at a time after the start: from 0 to 1, level at both ends
double push_share(double time_s) noexcept {
  const double u = std::min(time_s / SimulatedHand::kPushBuildUpS, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

/// \return the velocity after one tick under a force and a damper, the damper fully implicit
double velocity_after_tick(double velocity_mm_s, double force_n, double damping_n_s_per_mm,
                           double tick_per_mass) noexcept {
  return (velocity_mm_s + tick_per_mass * force_n) / (1.0 + tick_per_mass * damping_n_s_per_mm);
}

std::vector<DeviceListing> list_simulated(const DeviceSettings&) {
  DeviceListing listing;
  listing.driver = "simulated";
  listing.model = "simulated hand";
  listing.present = true;
  return {listing};
}

std::unique_ptr<HapticDevice> open_simulated(const DeviceSettings&) {
  RandomStream random(1, "simulated device");
  HandOptions hand;
  hand.explore_s = kNamedExploreS;
  ExplorationOptions exploration;
  exploration.duration_s = kNamedExploreS;
  return std::make_unique<SimulatedHand>(hand, ExplorationPath(kNamedPlane, exploration, random));
}

}  // namespace

SimulatedHand::SimulatedHand(const HandOptions& options, ExplorationPath path)
    : options_(options), path_(std::move(path)) {
  check(options);
  last_tick_ = std::llround(options.explore_s * kServoRateHz);
  const Vec2 start_mm = path_.at(0.0, stroke_).position_mm;
  state_.position_mm = {start_mm.x, start_mm.y, options.start_height_mm};
}

DeviceInfo SimulatedHand::info() const {
  return {"simulated", "", options_.max_force_n, true};
}

DeviceStatus SimulatedHand::read(DeviceSample& sample) noexcept {
  sample = state_;
  sample.sequence = static_cast<std::uint64_t>(tick_) + 1;
  return tick_ < last_tick_ ? DeviceStatus::ok : DeviceStatus::stopped;
}

DeviceStatus SimulatedHand::write(Vec3 force_n) noexcept {
  const double time_s = static_cast<double>(tick_) * kServoTickS;
  const double tick_per_mass = kServoTickS * kMmPerM / options_.mass_kg;
  const PathPoint target = path_.at(time_s, stroke_);
  const double damping = options_.arm_damping_n_s_per_mm;
  Vec3& position = state_.position_mm;
  Vec3& velocity = state_.velocity_mm_s;
  const Vec2 pull_n =
      options_.arm_stiffness_n_per_mm * (target.position_mm - Vec2{position.x, position.y}) +
      damping * target.velocity_mm_s;
  const double push_n = options_.push_n * push_share(time_s);
  velocity.x = velocity_after_tick(velocity.x, force_n.x + pull_n.x, damping, tick_per_mass);
  velocity.y = velocity_after_tick(velocity.y, force_n.y + pull_n.y, damping, tick_per_mass);
  velocity.z = velocity_after_tick(velocity.z, force_n.z - push_n, options_.push_damping_n_s_per_mm,
                                   tick_per_mass);
  position = position + kServoTickS * velocity;
  ++tick_;
  return DeviceStatus::ok;
}

std::chrono::nanoseconds SimulatedHand::now() const noexcept {
  return tick_ * kServoTick;
}

DeviceDriver simulated_driver() {
  return {"simulated", "a simulated hand that strokes a blank plane", list_simulated,
          open_simulated};
}

}  // namespace touchtrial::device

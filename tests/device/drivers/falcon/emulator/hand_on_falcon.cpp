#include "device/drivers/falcon/emulator/hand_on_falcon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace touchtrial::device::falcon {
namespace {

constexpr int kHomingTicks = 1000;
constexpr double kHomingTravelMm = 20.0;
constexpr double kCarryMmPerTick = 0.1;

}  // namespace

HandOnFalcon::HandOnFalcon(const device::PlanePlacement& placement, Vec3 rest_mm)
    : placement_(placement), rest_mm_(rest_mm), position_mm_(rest_mm) {}

Vec3 HandOnFalcon::tick(Vec3 force_n) {
  const std::scoped_lock lock(mutex_);
  switch (doing_) {
    case Doing::resting:
      break;
    case Doing::exploring:
      explore_on(force_n);
      break;
    default:
      carry();
      break;
  }
  return position_mm_;
}

void HandOnFalcon::home() {
  const std::scoped_lock lock(mutex_);
  from_mm_ = to_mm_ = position_mm_;
  doing_ = Doing::homing;
  tick_ = 0;
  ticks_ = kHomingTicks;
}

void HandOnFalcon::explore(device::SimulatedHand hand) {
  const std::scoped_lock lock(mutex_);
  hand_.emplace(std::move(hand));
  carry_to(hand_position_mm(), Doing::approaching);
}

int HandOnFalcon::explorations() const {
  const std::scoped_lock lock(mutex_);
  return explorations_;
}

void HandOnFalcon::carry_to(Vec3 target_mm, Doing doing) {
  from_mm_ = position_mm_;
  to_mm_ = target_mm;
  doing_ = doing;
  tick_ = 0;
  ticks_ = std::max(1, static_cast<int>(std::ceil(norm(to_mm_ - from_mm_) / kCarryMmPerTick)));
}

void HandOnFalcon::carry() {
  ++tick_;
  const double share = static_cast<double>(tick_) / ticks_;
  // Level at both ends: no step in velocity.
  const double smooth = share * share * (3.0 - 2.0 * share);
  position_mm_ = from_mm_ + smooth * (to_mm_ - from_mm_);
  if (doing_ == Doing::homing) {
    position_mm_.z += kHomingTravelMm * std::sin(2.0 * std::numbers::pi * smooth);
  }
  if (tick_ < ticks_) return;
  position_mm_ = to_mm_;
  doing_ = doing_ == Doing::approaching ? Doing::exploring : Doing::resting;
}

void HandOnFalcon::explore_on(Vec3 force_n) {
  // A simulated hand cannot fail; its next reading tells whether it has stopped.
  static_cast<void>(hand_->write(device::to_plane_direction(force_n, placement_.orientation)));
  position_mm_ = hand_position_mm();
  device::DeviceSample sample;
  if (hand_->read(sample) == device::DeviceStatus::ok) return;
  ++explorations_;
  carry_to(rest_mm_, Doing::returning);
}

Vec3 HandOnFalcon::hand_position_mm() {
  device::DeviceSample sample;
  static_cast<void>(hand_->read(sample));
  return placement_.origin_mm +
         device::to_device_direction(sample.position_mm, placement_.orientation);
}

}  // namespace touchtrial::device::falcon

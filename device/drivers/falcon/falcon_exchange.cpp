#include "device/drivers/falcon/falcon_exchange.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace touchtrial::device::falcon {

FalconExchange::FalconExchange(const FalconSettings& settings, DeviceLink& link) noexcept
    : link_(link), led_order_(settings.led_order), motors_(settings) {}

void FalconExchange::receive(std::span<const std::uint8_t> transfer) noexcept {
  const int replies = stream_.push_transfer(transfer);
  if (replies == 0) return;
  fresh_ = replied_ = true;
  // More replies than are due: to packets of another program, or late ones.
  due_ = std::max(0, due_ - replies);
}

void FalconExchange::publish(Time now) noexcept {
  if (!std::exchange(fresh_, false)) return;
  if (!take(stream_.newest(), now)) {
    bad_reading_ = true;
    return;
  }
  read_ = true;
  missing_ = 0;
  bad_reading_ = false;
  sense_at_ = stream_.discarded_bytes();
}

void FalconExchange::end() noexcept {
  overdue_ = due_ > 0 ? overdue_ + 1 : 0;
  if (overdue_ >= kLostAfterOverdue) due_ = overdue_ = 0;
  if (!read_) note_missing();
}

void FalconExchange::note_missing() noexcept {
  if (++missing_ < kLostAfter) return;
  const bool answers = bad_reading_ || stream_.discarded_bytes() != sense_at_;
  link_.fail(answers ? DeviceFault::bad_data : DeviceFault::link_lost);
}

bool FalconExchange::take(const Reply& reply, Time now) noexcept {
  homed_ = reply.all_homed();
  const Pose pose = forward_kinematics(theta1_of_counts(reply.counts));
  // Before homing the counts have no origin, so every count is possible.
  if (homed_ && pose.status == PoseStatus::out_of_reach) return false;
  const Vec3 position_mm = to_device_mm(pose.native_m);
  if (jumps(position_mm, now)) return false;
  pose_ = pose;
  pose_at_ = now;
  // Homing moves the origin, so earlier readings must not enter velocities.
  if (!known_ || !homed_) velocity_.forget();
  known_ = homed_;
  DeviceSample sample{position_mm, velocity_.add(position_mm, now), 0, reply.buttons, homed_};
  sample.limited = limited_;
  link_.publish(sample);
  return true;
}

bool FalconExchange::jumps(Vec3 position_mm, Time now) noexcept {
  if (!known_ || !homed_) return false;
  const double passed_s = std::chrono::duration<double>(now - pose_at_).count();
  const double distance_mm = norm(position_mm - to_device_mm(pose_.native_m));
  // Replies less than 1 ms apart are judged as if they were 1 ms apart: they may come together.
  if (distance_mm <= kMaxSpeedMmS * std::max(passed_s, 1e-3)) {
    jumps_ = 0;
    return false;
  }
  if (++jumps_ <= kMaxJumps) return true;
  jumps_ = 0;
  velocity_.forget();
  return false;
}

PerLeg FalconExchange::torques(Time now) noexcept {
  // Read even if it is not sent, so that no old force remains in the link.
  const Vec3 force_n = link_.force_to_send(now);
  if (!homed_ || !known_ || missing_ >= kForcelessAfter) return {};
  if (pose_.status != PoseStatus::ok) return {};
  return torques_nm(pose_.jacobian, force_n).value_or(PerLeg{});
}

Packet FalconExchange::begin(Time now) noexcept {
  replied_ = read_ = false;
  const MotorCommand motors = motors_.command(torques(now), now);
  limited_ = motors.limited;
  Command command;
  command.motors = motors.values;
  command.leds = led_bits({.red = !homed_, .blue = homed_}, led_order_);
  return encode_command(command);
}

}  // namespace touchtrial::device::falcon

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
  has_new_reply_ = has_reply_ = true;
  // There may be more replies than are due, for instance late ones.
  due_replies_ = std::max(0, due_replies_ - replies);
}

void FalconExchange::publish(Time now) noexcept {
  if (!std::exchange(has_new_reply_, false)) return;
  if (!accept_reading(stream_.newest(), now)) {
    has_bad_reading_ = true;
    return;
  }
  has_reading_ = true;
  missing_readings_ = 0;
  has_bad_reading_ = false;
  discarded_at_reading_ = stream_.discarded_bytes();
}

void FalconExchange::end() noexcept {
  overdue_exchanges_ = due_replies_ > 0 ? overdue_exchanges_ + 1 : 0;
  if (overdue_exchanges_ >= kLostAfterOverdue) due_replies_ = overdue_exchanges_ = 0;
  if (!has_reading_) count_missing_reading();
}

void FalconExchange::count_missing_reading() noexcept {
  if (++missing_readings_ < kLostAfter) return;
  const bool has_data = has_bad_reading_ || stream_.discarded_bytes() != discarded_at_reading_;
  link_.fail(has_data ? DeviceFault::bad_data : DeviceFault::link_lost);
}

bool FalconExchange::accept_reading(const Reply& reply, Time now) noexcept {
  is_homed_ = reply.all_homed();
  const Pose pose = forward_kinematics(theta1_of_counts(reply.counts));
  // Before homing the counts have no origin, so every count is possible.
  if (is_homed_ && pose.status == PoseStatus::out_of_reach) return false;
  const Vec3 position_mm = to_device_mm(pose.native_m);
  if (reject_jump(position_mm, now)) return false;
  pose_ = pose;
  pose_time_ = now;
  // Homing moves the origin, so earlier readings must not enter velocities.
  if (!has_pose_ || !is_homed_) velocity_.reset();
  has_pose_ = is_homed_;
  DeviceSample sample{position_mm, velocity_.add(position_mm, now), 0, reply.buttons, is_homed_};
  sample.limited = was_limited_;
  link_.publish(sample);
  return true;
}

bool FalconExchange::reject_jump(Vec3 position_mm, Time now) noexcept {
  if (!has_pose_ || !is_homed_) return false;
  const double elapsed_s = std::chrono::duration<double>(now - pose_time_).count();
  const double distance_mm = norm(position_mm - to_device_mm(pose_.native_m));
  // Replies may arrive together, so times below 1 ms count as 1 ms.
  if (distance_mm <= kMaxSpeedMmS * std::max(elapsed_s, 1e-3)) {
    jumps_ = 0;
    return false;
  }
  if (++jumps_ <= kMaxJumps) return true;
  jumps_ = 0;
  velocity_.reset();
  return false;
}

PerLeg FalconExchange::torques(Time now) noexcept {
  // Read even if not sent, so that no old force remains in the link.
  const Vec3 force_n = link_.force_to_send(now);
  if (!is_homed_ || !has_pose_ || missing_readings_ >= kForcelessAfter) return {};
  if (pose_.status != PoseStatus::ok) return {};
  return torques_nm(pose_.jacobian, force_n).value_or(PerLeg{});
}

Packet FalconExchange::begin(Time now) noexcept {
  has_reply_ = has_reading_ = false;
  const MotorCommand motors = motors_.command(torques(now), now);
  was_limited_ = motors.limited;
  Command command;
  command.motors = motors.values;
  command.leds = led_bits({.red = !is_homed_, .blue = is_homed_}, led_order_);
  return encode_command(command);
}

}  // namespace touchtrial::device::falcon

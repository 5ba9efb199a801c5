#include "device/falcon/falcon_exchange.hpp"

#include <algorithm>
#include <chrono>

namespace touchtrial::device::falcon {

FalconExchange::FalconExchange(const FalconSettings& settings, DeviceLink& link) noexcept
    : link_(link), gravity_bias_n_(settings.gravity_bias_n), led_order_(settings.led_order) {}

void FalconExchange::receive(std::span<const std::uint8_t> transfer) noexcept {
  if (stream_.push_transfer(transfer) > 0) fresh_ = true;
}

void FalconExchange::finish(Time now) noexcept {
  const bool good = fresh_ && take(stream_.newest(), now);
  if (fresh_ && !good) bad_reading_ = true;
  fresh_ = false;
  if (!good) return note_missing();
  missing_ = 0;
  bad_reading_ = false;
  sense_at_ = stream_.discarded_bytes();
}

void FalconExchange::note_missing() noexcept {
  if (++missing_ < kLostAfter) return;
  const bool answers = bad_reading_ || stream_.discarded_bytes() != sense_at_;
  link_.fail(answers ? DeviceFault::bad_data : DeviceFault::link_lost);
}

bool FalconExchange::take(const Reply& reply, Time now) noexcept {
  homed_ = reply.all_homed();
  const Pose pose =
      forward_kinematics(theta1_of_counts(reply.counts), known_ ? pose_.native_m : kCentreM);
  // Before homing the counts have no origin, so every count is possible.
  if (homed_ && pose.status == PoseStatus::out_of_reach) return false;
  const Vec3 position_mm = to_device_mm(pose.native_m);
  if (jumps(position_mm, now)) return false;
  pose_ = pose;
  pose_at_ = now;
  // Homing moves the origin, so readings before it say nothing about the hand's motion.
  if (!known_ || !homed_) velocity_.forget();
  known_ = homed_;
  const Vec3 velocity_mm_s = velocity_.add(position_mm, now);
  link_.publish({position_mm, velocity_mm_s, 0, reply.buttons, homed_});
  return true;
}

bool FalconExchange::jumps(Vec3 position_mm, Time now) noexcept {
  if (!known_ || !homed_) return false;
  const double passed_s = std::chrono::duration<double>(now - pose_at_).count();
  const double way_mm = norm(position_mm - to_device_mm(pose_.native_m));
  // Replies less than 1 ms apart are judged as if they were 1 ms apart: they may come together.
  if (way_mm <= kMostSpeedMmS * std::max(passed_s, 1e-3)) {
    jumps_ = 0;
    return false;
  }
  if (++jumps_ <= kMostJumps) return true;
  jumps_ = 0;
  velocity_.forget();
  return false;
}

Vec3 FalconExchange::bias_n(Time now) noexcept {
  if (!bias_from_) bias_from_ = now;
  const double share = std::chrono::duration<double>(now - *bias_from_) / kBiasRamp;
  return std::clamp(share, 0.0, 1.0) * gravity_bias_n_;
}

MotorValues FalconExchange::motors(Time now) noexcept {
  // Taken even if it is not sent, so that no old force waits in the link.
  const std::optional<Vec3> force_n = link_.live_force(now);
  if (!force_n || !homed_ || !known_ || missing_ > kForcelessAfter) {
    bias_from_.reset();
    return {};
  }
  const auto torques = torques_nm(pose_.jacobian, with_gravity_bias(*force_n, bias_n(now)));
  return torques && pose_.status == PoseStatus::ok ? motor_values(*torques) : MotorValues{};
}

Packet FalconExchange::command(Time now) noexcept {
  Command command;
  command.motors = motors(now);
  command.leds = led_bits({.red = !homed_, .blue = homed_}, led_order_);
  return encode_command(command);
}

}  // namespace touchtrial::device::falcon

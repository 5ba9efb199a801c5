#include "device/replay/replay_device.hpp"

#include <stdexcept>
#include <utility>

namespace touchtrial::device {

ReplayDevice::ReplayDevice(std::unique_ptr<const MotionSource> motion, double max_force_n)
    : motion_(std::move(motion)), max_force_n_(max_force_n) {
  if (motion_ == nullptr || !(max_force_n > 0.0)) {
    throw std::invalid_argument("ReplayDevice: no motion, or a force not above 0");
  }
  forces_n_.reserve(static_cast<std::size_t>(motion_->ticks()));
}

DeviceInfo ReplayDevice::info() const {
  DeviceInfo info{"replay", "", max_force_n_, true};
  info.max_rate_hz = motion_->rate_hz();
  return info;
}

DeviceStatus ReplayDevice::read(DeviceSample& sample) noexcept {
  const std::int64_t last = motion_->ticks() - 1;
  const std::int64_t tick = tick_ < last ? tick_ : last;
  sample = {};
  sample.position_mm = motion_->position_mm(tick);
  if (tick > 0) {
    const Vec3 step_mm = sample.position_mm - motion_->position_mm(tick - 1);
    sample.velocity_mm_s = motion_->rate_hz() * step_mm;
  }
  sample.sequence = static_cast<std::uint64_t>(tick_) + 1;
  return tick_ <= last ? DeviceStatus::ok : DeviceStatus::stopped;
}

DeviceStatus ReplayDevice::write(Vec3 force_n) noexcept {
  if (tick_ < motion_->ticks()) forces_n_.push_back(force_n);  // within what was reserved
  ++tick_;
  return DeviceStatus::ok;
}

}  // namespace touchtrial::device

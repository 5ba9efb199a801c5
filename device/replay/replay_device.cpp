#include "device/replay/replay_device.hpp"

namespace touchtrial::device {
namespace {

/// Of the device that is stood in for.
constexpr double kMaxForceN = 3.3;

}  // namespace

DeviceInfo ReplayDevice::info() const {
  DeviceInfo info{"replay", "", kMaxForceN, true};
  info.max_rate_hz = motion_.rate_hz();
  return info;
}

DeviceStatus ReplayDevice::read(DeviceSample& sample) noexcept {
  const std::int64_t last = motion_.ticks() - 1;
  const std::int64_t tick = tick_ < last ? tick_ : last;
  sample = {};
  sample.position_mm = motion_.position_mm(tick);
  if (tick > 0) {
    const Vec3 step_mm = sample.position_mm - motion_.position_mm(tick - 1);
    sample.velocity_mm_s = motion_.rate_hz() * step_mm;
  }
  sample.sequence = static_cast<std::uint64_t>(tick_) + 1;
  return tick_ <= last ? DeviceStatus::ok : DeviceStatus::stopped;
}

DeviceStatus ReplayDevice::write(Vec3) noexcept {
  ++tick_;
  return DeviceStatus::ok;
}

}  // namespace touchtrial::device

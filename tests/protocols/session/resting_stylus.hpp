/// \file A stylus that rests on the plane.
#pragma once

#include "device/haptic_device.hpp"

#include <cstdint>

namespace touchtrial {

/// Ends after some ticks, or is unplugged at one of them.
class RestingStylus final : public device::HapticDevice {
 public:
  explicit RestingStylus(int ticks, int lost_at = -1) : ticks_(ticks), lost_at_(lost_at) {}

  [[nodiscard]] device::DeviceInfo info() const override { return {"resting", "", 3.3, true}; }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    sample.position_mm = {10.0, 10.0, -1.0};
    sample.sequence = static_cast<std::uint64_t>(tick_) + 1;
    if (tick_ == lost_at_) return device::DeviceStatus::fault;
    return ++tick_ <= ticks_ ? device::DeviceStatus::ok : device::DeviceStatus::stopped;
  }
  [[nodiscard]] device::DeviceStatus write(Vec3) noexcept override {
    return device::DeviceStatus::ok;
  }
  void halt() noexcept override {}
  void rearm() noexcept override {}

 private:
  int ticks_;
  int lost_at_;
  int tick_ = 0;
};

}  // namespace touchtrial

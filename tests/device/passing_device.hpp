/// \file A device that passes everything on, for tests that change one part of another.
#pragma once

#include "device/haptic_device.hpp"

namespace touchtrial {

class PassingDevice : public device::HapticDevice {
 public:
  /// \param device  must outlive this
  explicit PassingDevice(device::HapticDevice& device) noexcept : device_(device) {}

  [[nodiscard]] device::DeviceInfo info() const override { return device_.info(); }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    return device_.read(sample);
  }
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    return device_.write(force_n);
  }
  [[nodiscard]] Vec3 support_force_n(const device::DeviceSample& sample) noexcept override {
    return device_.support_force_n(sample);
  }
  void halt() noexcept override { device_.halt(); }
  void rearm() noexcept override { device_.rearm(); }
  [[nodiscard]] device::DeviceFault fault() const noexcept override { return device_.fault(); }
  [[nodiscard]] device::DeviceReadiness readiness() const noexcept override {
    return device_.readiness();
  }

 private:
  device::HapticDevice& device_;
};

}  // namespace touchtrial

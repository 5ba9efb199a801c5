/// \file One exchange with a Falcon for each tick of a servo, in virtual time: what a test in which
/// nothing depends on how fast the machine is needs.
#pragma once

#include "device/falcon/falcon_device.hpp"

#include <memory>

namespace touchtrial::device::falcon {

/// Lets the USB thread of one FalconDevice go on, one exchange at a time.
class Lockstep {
 public:
  Lockstep();
  ~Lockstep();

  /// For the device's options; once.
  [[nodiscard]] std::unique_ptr<FalconPace> pace();
  /// One whole exchange; returns when the USB thread rests again, or has ended. One thread.
  void step() noexcept;
  /// So many.
  void steps(int count) noexcept;

  struct State;

 private:
  std::shared_ptr<State> state_;
};

/// The same device; each `read` is of an exchange of its own, which takes the force written before.
class LockstepDevice final : public device::HapticDevice {
 public:
  /// \param device, lockstep  must outlive this
  LockstepDevice(device::HapticDevice& device, Lockstep& lockstep) noexcept
      : device_(device), lockstep_(lockstep) {}

  [[nodiscard]] device::DeviceInfo info() const override { return device_.info(); }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    lockstep_.step();
    return device_.read(sample);
  }
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    return device_.write(force_n);
  }
  void halt() noexcept override { device_.halt(); }
  void rearm() noexcept override { device_.rearm(); }
  [[nodiscard]] device::DeviceFault fault() const noexcept override { return device_.fault(); }
  [[nodiscard]] device::DeviceReadiness readiness() const noexcept override {
    return device_.readiness();
  }

 private:
  device::HapticDevice& device_;
  Lockstep& lockstep_;
};

}  // namespace touchtrial::device::falcon

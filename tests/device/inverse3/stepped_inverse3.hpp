/// \file The real driver on the emulated service, one exchange a tick of the servo, so that nothing
/// depends on the speed of the machine.
#pragma once

#include "device/inverse3/inverse3_device.hpp"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>

namespace touchtrial::testing {

/// The time by which the driver judges a force's age. It passes when a test says so.
using TestTime = std::atomic<device::ServoClock::Time>;

/// Options for a machine of any speed: only what hangs is given up, and exchanges follow each other
/// as they can.
/// \param time  null: it stands still
[[nodiscard]] device::inverse3::Inverse3Options patient_options(
    std::shared_ptr<TestTime> time = nullptr);

/// Every `read` runs one exchange, which sends the force of the last `write`.
class SteppedInverse3 final : public device::HapticDevice {
 public:
  /// \param before_read  on the servo's thread, while the driver's thread rests; may be empty
  explicit SteppedInverse3(const device::Inverse3Settings& settings,
                           std::function<void()> before_read = {});
  ~SteppedInverse3() override;

  [[nodiscard]] device::DeviceInfo info() const override { return device_->info(); }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override;
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    return device_->write(force_n);
  }
  void halt() noexcept override { device_->halt(); }
  void rearm() noexcept override { device_->rearm(); }
  [[nodiscard]] device::DeviceFault fault() const noexcept override { return device_->fault(); }
  [[nodiscard]] device::DeviceReadiness readiness() const noexcept override {
    return device_->readiness();
  }

 private:
  struct Steps;
  class Clock;
  /// Runs one exchange; returns when the driver's thread rests again, or has failed.
  void step() noexcept;

  std::shared_ptr<Steps> steps_;
  std::function<void()> before_read_;
  std::unique_ptr<device::inverse3::Inverse3Device> device_;
};

}  // namespace touchtrial::testing

/// \file Devices whose threads go on by a clock of the test: one exchange a millisecond, whatever
/// the machine's speed.
#pragma once

#include "device/drivers/falcon/rig/falcon_rig.hpp"
#include "device/drivers/plugin/plugin_device.hpp"
#include "device/passing_device.hpp"
#include "device/servo/servo_clock.hpp"

#include <chrono>
#include <memory>
#include <utility>
#include <vector>

namespace touchtrial {

/// Time that passes when somebody waits for it; each millisecond lets every device go on by one
/// exchange.
class LockstepClock final : public device::ServoClock {
 public:
  /// \return the pace of one more device, whose opening may fail
  [[nodiscard]] std::unique_ptr<device::LinkPace> pace() {
    locksteps_.push_back(std::make_unique<device::falcon::Lockstep>());
    return std::make_unique<EndingPace>(locksteps_.back()->pace());
  }
  [[nodiscard]] device::PluginOptions plugin_options() {
    return {.pace = pace(), .scheduling = {device::SchedulingPolicy::other, 0, false}};
  }

  [[nodiscard]] Time now() noexcept override { return now_; }
  void wait_until(Time time) noexcept override {
    for (; now_ < time; now_ += std::chrono::milliseconds(1)) {
      for (const auto& lockstep : locksteps_) lockstep->step();
    }
  }
  void pass_ms(int count) noexcept { wait_until(now_ + std::chrono::milliseconds(count)); }

 private:
  /// Nobody waits for a device that never came to be.
  class EndingPace final : public device::LinkPace {
   public:
    explicit EndingPace(std::unique_ptr<device::LinkPace> pace) : pace_(std::move(pace)) {}
    ~EndingPace() override { pace_->end(); }
    [[nodiscard]] Time now() noexcept override { return pace_->now(); }
    void rest_until(Time time) noexcept override { pace_->rest_until(time); }
    void end() noexcept override { pace_->end(); }

   private:
    std::unique_ptr<device::LinkPace> pace_;
  };

  std::vector<std::unique_ptr<device::falcon::Lockstep>> locksteps_;
  Time now_{};
};

/// The same clock for the servo's device: every `read` is a millisecond.
class LockstepHaptics final : public PassingDevice {
 public:
  /// \param device,clock  must outlive this
  LockstepHaptics(device::HapticDevice& device, LockstepClock& clock) noexcept
      : PassingDevice(device), clock_(clock) {}

  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override {
    clock_.pass_ms(1);
    return PassingDevice::read(sample);
  }

 private:
  LockstepClock& clock_;
};

}  // namespace touchtrial

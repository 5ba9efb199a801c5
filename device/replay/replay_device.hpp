/// \file A hand that repeats a recorded motion, whatever it feels.
#pragma once

#include "device/haptic_device.hpp"
#include "device/replay/motion.hpp"

#include <cstdint>
#include <utility>

namespace touchtrial::device {

/// The driver "replay". Each `write` is one tick, so it works in virtual time as in real time; run
/// the servo at the motion's rate. Positions are the recorded ones, in the plane frame; the
/// velocity is that of the last step. Forces move nothing. Not thread-safe.
class ReplayDevice final : public HapticDevice {
 public:
  explicit ReplayDevice(RecordedMotion motion) : motion_(std::move(motion)) {}

  [[nodiscard]] DeviceInfo info() const override;
  /// \return stopped once the motion is at its end
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// Does nothing: no force reaches a person.
  void halt() noexcept override {}
  void rearm() noexcept override {}

 private:
  RecordedMotion motion_;
  std::int64_t tick_ = 0;
};

}  // namespace touchtrial::device

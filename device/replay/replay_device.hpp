/// \file A hand that repeats a recorded motion, whatever it feels.
#pragma once

#include "device/haptic_device.hpp"
#include "device/replay/motion.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace touchtrial::device {

/// The driver "replay". Each `write` is one tick, so it goes in virtual time as in real time; run
/// the servo at the motion's rate. Positions are the recorded ones, in the plane frame; velocity is
/// the last step's. Forces move nothing; they are kept, to be held against those of the recording.
/// Not thread-safe.
class ReplayDevice final : public HapticDevice {
 public:
  /// \param max_force_n  of the device that is stood in for, > 0
  /// \throws std::invalid_argument if the force is out of range or there is no motion
  explicit ReplayDevice(std::unique_ptr<const MotionSource> motion, double max_force_n = 3.3);

  [[nodiscard]] DeviceInfo info() const override;
  /// \return stopped once the motion is at its end
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// Nothing to do: no force reaches anybody.
  void halt() noexcept override {}
  void rearm() noexcept override {}

  /// What was written during the motion, a force a tick.
  [[nodiscard]] std::span<const Vec3> forces_n() const noexcept { return forces_n_; }

 private:
  std::unique_ptr<const MotionSource> motion_;
  double max_force_n_;
  std::int64_t tick_ = 0;
  std::vector<Vec3> forces_n_;
};

}  // namespace touchtrial::device

/// \file How a driver's own thread and the servo exchange states and forces.
#pragma once

#include "device/haptic_device.hpp"
#include "device/latest_value.hpp"

#include <atomic>
#include <chrono>
#include <optional>

namespace touchtrial::device {

/// Lock-free exchange for drivers whose link (USB transfers, a vendor's scheduler) lives on a
/// thread of its own. The driver forwards HapticDevice's functions of the same names to it.
class DeviceLink {
 public:
  using Time = std::chrono::nanoseconds;  ///< of one monotonic clock, chosen by the driver

  /// A force that the servo has not renewed for this long is sent as zero: the servo is stuck.
  static constexpr Time kForceLifetime = std::chrono::milliseconds(10);

  /// \name Servo thread
  ///@{
  /// The newest sample. \return fault once `fail` was called; `stopped` never
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept;
  [[nodiscard]] DeviceStatus write(Vec3 force_n, Time now) noexcept;
  ///@}

  /// \name Any thread, and signal handlers
  ///@{
  void halt() noexcept { halted_.store(true, std::memory_order_release); }
  void rearm() noexcept { halted_.store(false, std::memory_order_release); }
  [[nodiscard]] DeviceFault fault() const noexcept {
    return fault_.load(std::memory_order_acquire);
  }
  /// Latches the first fault; zero force from now on. A link that failed is opened anew.
  void fail(DeviceFault fault) noexcept;
  ///@}

  /// \name Driver's thread
  ///@{
  /// Numbers the sample itself.
  void publish(DeviceSample sample) noexcept;
  /// What to send now, device frame, N: the servo's newest force, or zero if there is none, if it
  /// is too old, or after `halt` or `fail`.
  [[nodiscard]] Vec3 force_to_send(Time now) noexcept { return live_force(now).value_or(Vec3{}); }
  /// The same, but nothing where there is none: for drivers that add to a force.
  [[nodiscard]] std::optional<Vec3> live_force(Time now) noexcept;
  ///@}

 private:
  struct TimedForce {
    Vec3 force_n;
    Time written_at{};
    bool any = false;
  };

  LatestValue<DeviceSample> samples_{DeviceSample{{}, {}, 0, 0, false}};
  LatestValue<TimedForce> forces_;
  std::uint64_t published_ = 0;
  std::atomic<bool> halted_{false};
  std::atomic<DeviceFault> fault_{DeviceFault::none};
};

}  // namespace touchtrial::device

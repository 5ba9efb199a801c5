/// \file The callback that the vendor's scheduler thread runs once a tick.
#pragma once

#include "device/device_link.hpp"
#include "device/openhaptics/hd_api.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>

namespace touchtrial::device::hd {

/// What the device offers, as found when it was opened.
struct LoopOptions {
  bool has_motor_temperature = false;
  int calibration_style = kStyleInkwell;  ///< 0: none that a program can do
};

/// The callback's data, and all that it touches. The thread that opens the device makes and
/// destroys it.
class Loop {
 public:
  /// On the vendor's scale from 0 (cold) to 1 (as warm as a motor may get). The library raises an
  /// error at 1; we stop a little before that, while the motors still obey.
  static constexpr double kWarmestMotor = 0.95;

  Loop(const Api& api, Handle device, const LoopOptions& options) noexcept
      : api_(api), device_(device), options_(options) {}

  /// For the scheduler, with the loop as data.
  static std::uint32_t callback(void* loop) noexcept;

  [[nodiscard]] DeviceLink& link() noexcept { return link_; }
  [[nodiscard]] const DeviceLink& link() const noexcept { return link_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept {
    return readiness_.load(std::memory_order_acquire);
  }
  /// \return the number of frames in a row, up to now, that sent zero
  [[nodiscard]] int zeros_sent() const noexcept {
    return zeros_sent_.load(std::memory_order_acquire);
  }

  /// Makes all further callbacks return at once and end themselves.
  /// \return false if one is still inside the vendor's library after the patience: this object must
  ///   then never be destroyed
  [[nodiscard]] bool close(std::chrono::milliseconds patience) noexcept;

 private:
  [[nodiscard]] std::uint32_t enter() noexcept;
  void tick() noexcept;
  [[nodiscard]] bool check_calibration() noexcept;
  void run_frame(bool calibrated) noexcept;
  [[nodiscard]] DeviceSample read_sample() noexcept;
  void watch_temperature() noexcept;
  void send(Vec3 force_n) noexcept;

  Api api_;
  Handle device_;
  LoopOptions options_;
  DeviceLink link_;
  std::int64_t tick_ = 0;
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<int> zeros_sent_{0};
  std::atomic<bool> inside_{false};
  std::atomic<bool> closed_{false};
};

}  // namespace touchtrial::device::hd

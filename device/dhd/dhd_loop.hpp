/// \file The thread that talks to a DHD device.
#pragma once

#include "device/device_link.hpp"
#include "device/dhd/dhd_api.hpp"

#include <atomic>
#include <cstdint>
#include <thread>

namespace touchtrial::device::dhd {

/// About the rate that the device's USB link allows.
constexpr double kPollRateHz = 4000.0;

/// Polls the device from its construction to its destruction, in real time where the system permits
/// it. The last forces that it sends are zeros.
class Loop {
 public:
  /// \param api  must outlive this
  /// \param device  must stay open as long
  Loop(const Api& api, char device);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] DeviceLink& link() noexcept { return link_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept {
    return readiness_.load(std::memory_order_acquire);
  }

 private:
  void run() noexcept;
  [[nodiscard]] bool may_push() const noexcept {
    return force_on_ && readiness() == DeviceReadiness::ready;
  }
  void tick() noexcept;
  void check_status() noexcept;
  void judge_force_off(int cause) noexcept;
  void take_sample() noexcept;
  void send(Vec3 force_n) noexcept;
  void fail_call() noexcept;

  const Api& api_;
  char device_;
  DeviceLink link_;
  bool force_on_ = false;
  std::int64_t tick_ = 0;
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<bool> closing_{false};
  std::thread thread_;
};

}  // namespace touchtrial::device::dhd

/// \file The thread that talks to a Force Dimension device. Private to this folder.
#pragma once

#include "device/drivers/device_link.hpp"
#include "device/drivers/dhd/dhd_library.hpp"
#include "device/servo/velocity_estimate.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>

namespace touchtrial::device::dhd {

/// About the rate that the device's USB link allows.
constexpr double kPollRateHz = 4000.0;

/// Readings of the velocity's regression line: at 4 kHz its lag is 1 ms, and steps of 0.01 mm cause
/// 1.5 mm/s of noise. The library's own velocity compares positions 20 ms apart, which lags by 10
/// ms.
constexpr std::size_t kVelocityReadings = 9;

/// Polls the device from its construction to its destruction, in real time where the system permits
/// it. Force is on only while the device is calibrated, and neither halted nor failed; at the end
/// it sends zeros, then switches force off.
///
/// A reading counts as new if the library exchanged data with the device since the previous one,
/// for position or force: dhdSetForce fetches positions that dhdGetPosition then returns with the
/// time guard's result. Changed values are no criterion, because a device at rest repeats them. A
/// thread that waits for the device makes no reading.
class Loop {
 public:
  using Time = std::chrono::nanoseconds;
  using Now = Time (*)();

  /// \param api  must outlive this
  /// \param device  must stay open as long
  /// \param max_weight_n  the largest weight that the library may add, else force is not switched
  ///   on; nothing: it adds none
  /// \param now  the time of a reading, for velocities
  Loop(const Api& api, char device, std::optional<double> max_weight_n, Now now);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] DeviceLink& link() noexcept { return link_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept {
    return readiness_.load(std::memory_order_acquire);
  }

 private:
  void run() noexcept;
  void tick() noexcept;
  void check_status() noexcept;
  void note_force(bool is_on, int cause) noexcept;
  [[nodiscard]] DeviceReadiness need() const noexcept;
  void switch_force() noexcept;
  void switch_off() noexcept;
  [[nodiscard]] bool is_weight_plausible() const noexcept;
  void take_sample() noexcept;
  void send(Vec3 force_n) noexcept;
  void fail_call() noexcept;
  [[nodiscard]] bool may_push() const noexcept { return force_on_ && calibrated_; }

  const Api& api_;
  char device_;
  std::optional<double> max_weight_n_;
  Now now_;
  DeviceLink link_;
  VelocityEstimate<kVelocityReadings> velocity_;
  bool calibrated_ = false;
  bool switched_on_ = false;  ///< we requested force, and have not switched it off since
  bool force_on_ = false;     ///< by the device's status
  bool was_on_ = false;       ///< since our request
  bool exchanged_ = true;     ///< data with the device since the last reading
  bool saturated_ = false;    ///< motors, by the newest force
  std::int64_t tick_ = 0;
  std::int64_t switched_at_ = 0;
  std::int64_t status_at_ = 0;  ///< when it is due next
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<bool> closing_{false};
  std::thread thread_;
};

}  // namespace touchtrial::device::dhd

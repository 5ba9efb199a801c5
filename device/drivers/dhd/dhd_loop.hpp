/// \file The thread that communicates with a Force Dimension device. Private to this folder.
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

/// Readings per velocity estimate: at 4 kHz the lag is 1 ms, and steps of 0.01 mm cause 1.5 mm/s of
/// noise. The library's own velocity compares positions 20 ms apart, so it lags by 10 ms.
constexpr std::size_t kVelocityReadings = 9;

/// Polls the device during its own lifetime, in real time if the system permits it. Force is on
/// only while the device is calibrated and neither halted nor failed. The destructor sends zeros,
/// then switches force off.
///
/// A reading is new if the library has exchanged data with the device since the previous one, for
/// position or force: dhdSetForce fetches positions that dhdGetPosition then returns with the time
/// guard's result. Values are not compared, because a device at rest repeats them.
class Loop {
 public:
  using Time = std::chrono::nanoseconds;
  using Now = Time (*)();

  /// \param api  must outlive this
  /// \param device  must stay open during the lifetime of this
  /// \param max_weight_n  if the library adds a larger weight, force is not switched on; nothing if
  ///   it adds none
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
  void update_force_state(bool is_on, int cause) noexcept;
  [[nodiscard]] DeviceReadiness required_action() const noexcept;
  void update_force_switch() noexcept;
  void switch_off() noexcept;
  [[nodiscard]] bool is_weight_plausible() const noexcept;
  void publish_sample() noexcept;
  void send(Vec3 force_n) noexcept;
  void report_failed_call() noexcept;
  [[nodiscard]] bool is_force_allowed() const noexcept { return is_force_on_ && is_calibrated_; }

  const Api& api_;
  char device_;
  std::optional<double> max_weight_n_;
  Now now_;
  DeviceLink link_;
  VelocityEstimate<kVelocityReadings> velocity_;
  bool is_calibrated_ = false;
  bool is_force_requested_ = false;  ///< by this driver, and not switched off since
  bool is_force_on_ = false;         ///< by the device's status
  bool was_force_on_ = false;        ///< since the request
  bool has_exchanged_ = true;        ///< data was exchanged with the device since the last reading
  bool is_saturated_ = false;        ///< the motors exert less than the newest force
  std::int64_t tick_ = 0;
  std::int64_t requested_at_ = 0;
  std::int64_t next_status_ = 0;  ///< the tick of the next status check
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<bool> closing_{false};
  std::thread thread_;
};

}  // namespace touchtrial::device::dhd

/// \file A thread that sets the force to zero when the servo itself stalls.
#pragma once

#include "device/haptic_device.hpp"
#include "device/servo/servo.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <thread>

namespace touchtrial::device {

/// The watchdog's clock, so that tests control it. Belongs to the watchdog's thread; any thread may
/// call `now`.
class WatchdogTime {
 public:
  using Time = std::chrono::nanoseconds;
  virtual ~WatchdogTime() = default;

  [[nodiscard]] virtual Time now() noexcept = 0;
  /// Returns after about this time at the latest.
  virtual void pause(Time time) noexcept = 0;
};

/// The system's monotonic clock.
[[nodiscard]] WatchdogTime& system_watchdog_time() noexcept;

/// Checks a servo's heartbeat five times in `silence`. A servo whose heartbeat stops for this long
/// before the end of its run has stalled: the watchdog halts the device, and the run ends as
/// SafetyFault::stalled when the servo continues. Time in which the watchdog itself did not run
/// (for example, a stalled virtual machine) does not count: one check counts for two of its pauses
/// at most.
///
/// The thread requests real-time scheduling above the servo's, so that a spinning servo cannot
/// starve it, and works without it if it is refused. Any thread may call all functions.
class Watchdog {
 public:
  /// For a device whose force a hand feels.
  static constexpr std::chrono::milliseconds kSilence{10};
  /// For any other.
  static constexpr std::chrono::milliseconds kForcelessSilence{1000};

  /// A constant force pushes a real hand, but not a simulated hand or one at a mouse. For those a
  /// busy machine is not a fault, only a servo that never continues.
  /// \return how long the servo of a device may be silent
  [[nodiscard]] static std::chrono::milliseconds silence_for(const DeviceInfo& device) noexcept {
    return device.simulated || device.visual ? kForcelessSilence : kSilence;
  }

  /// \param device,control,heartbeat  must outlive this; control and heartbeat are the ServoHooks'
  /// \param silence  > 0
  /// \throws std::invalid_argument if the silence is not > 0
  Watchdog(HapticDevice& device, ServoControl& control, const std::atomic<std::int64_t>& heartbeat,
           std::chrono::nanoseconds silence = kSilence,
           WatchdogTime& time = system_watchdog_time());
  /// Ends the thread, within a fifth of the silence.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Before a run. Silence counts from the first beat.
  void arm();
  /// After a run: disables the watchdog.
  /// \return whether it tripped since `arm`; then the device stays halted until a person re-arms
  ///   it, even if the run had just ended by itself
  bool disarm();

 private:
  void watch() noexcept;
  void look(WatchdogTime::Time passed) noexcept;

  HapticDevice& device_;
  ServoControl& control_;
  const std::atomic<std::int64_t>& heartbeat_;
  const std::chrono::nanoseconds silence_;
  const std::chrono::nanoseconds pause_;
  WatchdogTime& time_;

  std::mutex mutex_;  ///< guards the next five members; the servo never takes it
  bool armed_ = false;
  bool tripped_ = false;
  bool beating_ = false;
  std::int64_t last_beat_ = 0;
  std::chrono::nanoseconds silent_{};

  std::atomic<bool> ends_{false};
  std::thread thread_;  ///< last, as it uses all of the above
};

/// Arms a watchdog for the length of a scope.
class WatchdogGuard {
 public:
  explicit WatchdogGuard(Watchdog& watchdog) : watchdog_(watchdog) { watchdog_.arm(); }
  ~WatchdogGuard() { watchdog_.disarm(); }
  WatchdogGuard(const WatchdogGuard&) = delete;
  WatchdogGuard& operator=(const WatchdogGuard&) = delete;

 private:
  Watchdog& watchdog_;
};

}  // namespace touchtrial::device

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
  /// Returns after about this time or earlier.
  virtual void pause(Time time) noexcept = 0;
};

/// The system's monotonic clock.
[[nodiscard]] WatchdogTime& system_watchdog_time() noexcept;

/// Checks a servo's heartbeat five times per `silence`. A servo whose heartbeat stops for this long
/// during a run has stalled: the watchdog halts the device, and the run ends as
/// SafetyFault::stalled when the servo continues. Time in which the watchdog itself did not run
/// (for example, a stalled virtual machine) hardly counts: each check adds two pauses at most.
///
/// The thread requests real-time scheduling above the servo's, so that a spinning servo cannot
/// starve it; if that is refused, it runs as an ordinary thread. Any thread may call all functions.
class Watchdog {
 public:
  /// The silence for a device whose force a hand feels.
  static constexpr std::chrono::milliseconds kSilence{10};
  /// The silence for any other device.
  static constexpr std::chrono::milliseconds kForcelessSilence{1000};

  /// A stalled servo's constant force pushes only a real hand. On simulated and visual
  /// devices, a servo delayed by a busy machine is not a fault; one that never continues is.
  /// \return the silence allowed for this device
  [[nodiscard]] static std::chrono::milliseconds silence_for(const DeviceInfo& device) noexcept {
    return device.simulated || device.visual ? kForcelessSilence : kSilence;
  }

  /// \param device,control,heartbeat  must outlive this; control and heartbeat as in ServoHooks
  /// \param silence  > 0
  /// \throws std::invalid_argument if the silence is not > 0
  Watchdog(HapticDevice& device, ServoControl& control, const std::atomic<std::int64_t>& heartbeat,
           std::chrono::nanoseconds silence = kSilence,
           WatchdogTime& time = system_watchdog_time());
  /// Ends the thread, within a fifth of the silence.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Call it before a run. Silence counts from the first beat.
  void arm();
  /// Disables the watchdog; call it after a run.
  /// \return whether it has tripped since `arm`. If so, the device stays halted until a person
  ///   re-arms it, even if the run had just ended normally.
  bool disarm();

 private:
  void watch() noexcept;
  void check_heartbeat(WatchdogTime::Time elapsed) noexcept;

  HapticDevice& device_;
  ServoControl& control_;
  const std::atomic<std::int64_t>& heartbeat_;
  const std::chrono::nanoseconds silence_;
  const std::chrono::nanoseconds pause_;
  WatchdogTime& time_;

  std::mutex mutex_;  ///< guards the next five members; the servo never locks it
  bool is_armed_ = false;
  bool has_tripped_ = false;
  bool is_beating_ = false;
  std::int64_t last_beat_ = 0;
  std::chrono::nanoseconds elapsed_silence_{};

  std::atomic<bool> stop_requested_{false};
  std::thread thread_;  ///< last, because it uses all other members
};

/// Arms a watchdog for the duration of a scope.
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

/// \file Zero force when the servo itself stands still, by a thread of its own.
#pragma once

#include "device/haptic_device.hpp"
#include "device/servo/servo.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <thread>

namespace touchtrial::device {

/// Time as the watchdog sees it, so that tests own it. Used by the watchdog's thread, `now` by any.
class WatchdogTime {
 public:
  using Time = std::chrono::nanoseconds;
  virtual ~WatchdogTime() = default;

  [[nodiscard]] virtual Time now() noexcept = 0;
  /// Returns after about this time, or earlier.
  virtual void pause(Time time) noexcept = 0;
};

/// The system's monotonic clock.
[[nodiscard]] WatchdogTime& system_watchdog_time() noexcept;

/// Looks at a servo's heartbeat five times in `silence`. A servo that has begun to beat, and then
/// is silent for so long without having ended its run, stands still: the device is halted, and the
/// run will end as SafetyFault::stalled when it goes on. A pause in which the watchdog itself did
/// not run (a virtual machine that stalls as a whole) is no evidence: a look never counts for more
/// than two of its pauses.
///
/// The thread asks for real-time scheduling above the servo's, so that a spinning servo cannot
/// starve it, and goes on without. All functions may be called from any thread.
class Watchdog {
 public:
  /// On a device whose force a hand feels.
  static constexpr std::chrono::milliseconds kSilence{10};
  /// Where none does.
  static constexpr std::chrono::milliseconds kForcelessSilence{1000};

  /// How long the servo of a device may be silent. A force that stays as it is pushes a hand on; a
  /// simulated hand, and a hand at a mouse, are pushed by nothing, so that there only a servo that
  /// does not come back is a fault, and not a busy machine.
  [[nodiscard]] static std::chrono::milliseconds silence_for(const DeviceInfo& device) noexcept {
    return device.simulated || device.visual ? kForcelessSilence : kSilence;
  }

  /// \param device,control,heartbeat  must outlive this; the last two are those of the ServoHooks
  /// \param silence  > 0
  /// \throws std::invalid_argument if the silence is not > 0
  Watchdog(HapticDevice& device, ServoControl& control, const std::atomic<std::int64_t>& heartbeat,
           std::chrono::nanoseconds silence = kSilence,
           WatchdogTime& time = system_watchdog_time());
  /// Ends the thread; takes up to a fifth of the silence.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Before a run. Silence counts from the first beat on.
  void arm();
  /// After a run: from here on nothing trips. \return whether it tripped since `arm`. Then the
  /// device stays halted until somebody re-arms it, also if the run had just ended by itself.
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

  std::mutex mutex_;  ///< never taken by the servo; guards what follows
  bool armed_ = false;
  bool tripped_ = false;
  bool beating_ = false;
  std::int64_t last_beat_ = 0;
  std::chrono::nanoseconds silent_{};

  std::atomic<bool> ends_{false};
  std::thread thread_;  ///< last: it uses all of the above
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

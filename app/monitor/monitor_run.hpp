/// \file The servo behind a monitor: on a thread of its own, started and stopped by a person.
#pragma once

#include "app/monitor/monitor_history.hpp"
#include "app/monitor/test_wall.hpp"
#include "device/platform/stop_signals.hpp"
#include "device/safety/watchdog.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_thread.hpp"

#include <atomic>
#include <cstdint>
#include <optional>

namespace touchtrial {

/// Runs a device against the test wall, under a watchdog, and halts it by signals as long as this
/// lives. Belongs to one thread; none of its functions waits for the servo but the destructor.
class MonitorRun {
 public:
  /// \param device  must outlive this
  /// \param rate_hz  1,000 to 10,000
  /// \throws std::logic_error if there is another StopOnSignals
  MonitorRun(HapticDevice& device, double rate_hz, const SafetyLimits& limits,
             WatchdogTime& time = system_watchdog_time());
  /// The force fades to zero and the servo ends.
  ~MonitorRun();
  MonitorRun(const MonitorRun&) = delete;
  MonitorRun& operator=(const MonitorRun&) = delete;

  /// A person's decision: re-arms the device and runs the servo. Does nothing while it runs, or
  /// once a signal has asked the program to end.
  void start();
  void comfort_stop() noexcept { control_.comfort_stop(); }
  [[nodiscard]] bool running();
  /// How the last run ended; nothing while one runs, or before the first.
  [[nodiscard]] std::optional<ServoReport> ended();

  [[nodiscard]] TestWall& wall() noexcept { return wall_; }
  [[nodiscard]] const ServoState& newest() noexcept { return states_.get(); }
  [[nodiscard]] const SchedulingObtained& scheduling() const noexcept {
    return thread_.scheduling();
  }
  /// Moves what has come since the last time into the history.
  void collect(MonitorHistory& history);

 private:
  void run() noexcept;

  HapticDevice& device_;
  ServoOptions options_;
  TestWall wall_;
  SampleRing ring_;
  RingSink sink_;
  ServoControl control_;
  std::atomic<std::int64_t> heartbeat_{0};
  Watchdog watchdog_;
  StopOnSignals signals_;
  LatestValue<ServoState> states_;
  std::atomic<std::int64_t> worst_late_ns_{-1};  ///< since the last `collect`
  ServoReport report_;
  bool waited_for_ = true;
  bool has_run_ = false;
  ServoThread thread_;  ///< last: it ends before what it uses, and before what guards it
};

}  // namespace touchtrial

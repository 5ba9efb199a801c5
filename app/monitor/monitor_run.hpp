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

namespace touchtrial::app {

/// Runs a device against the test wall, under a watchdog, and halts it by signals as long as this
/// lives. Belongs to one thread; none of its functions waits for the servo but the destructor.
class MonitorRun {
 public:
  /// \param device  must outlive this
  /// \param rate_hz  1,000 to 10,000
  /// \throws std::logic_error if there is another StopOnSignals
  MonitorRun(device::HapticDevice& device, double rate_hz, const device::SafetyLimits& limits,
             device::WatchdogTime& time = device::system_watchdog_time());
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
  [[nodiscard]] std::optional<device::ServoReport> ended();

  [[nodiscard]] TestWall& wall() noexcept { return wall_; }
  [[nodiscard]] const device::ServoState& newest() noexcept { return states_.get(); }
  [[nodiscard]] const device::SchedulingObtained& scheduling() const noexcept {
    return thread_.scheduling();
  }
  /// Moves what has come since the last time into the history.
  void collect(MonitorHistory& history);

 private:
  void run() noexcept;

  device::HapticDevice& device_;
  device::ServoOptions options_;
  TestWall wall_;
  device::SampleRing ring_;
  device::RingSink sink_;
  device::ServoControl control_;
  std::atomic<std::int64_t> heartbeat_{0};
  device::Watchdog watchdog_;
  device::StopOnSignals signals_;
  device::LatestValue<device::ServoState> states_;
  std::atomic<std::int64_t> worst_late_ns_{-1};  ///< since the last `collect`
  device::ServoReport report_;
  bool waited_for_ = true;
  bool has_run_ = false;
  device::ServoThread thread_;  ///< last: it ends before what it uses, and before what guards it
};

}  // namespace touchtrial::app

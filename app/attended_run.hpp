/// \file Runs of the servo that a person attends at a terminal: live figures, keys, watchdog,
/// signals.
#pragma once

#include "app/terminal_keys.hpp"
#include "app/windows/opened_device.hpp"
#include "device/platform/stop_signals.hpp"
#include "device/safety/watchdog.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_thread.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace touchtrial::app {

/// What the person, or a signal, asked for.
enum class AttendedStop {
  none,
  quit,     ///< q
  comfort,  ///< the space bar, or the window's own way
  signal,   ///< Ctrl-C, or the program was asked to end
};

/// A person needs no longer to home a device.
inline constexpr double kReadyLimitS = 120.0;

/// One device and everything around its servo. Belongs to the main thread.
class AttendedRun {
 public:
  static constexpr double kRecordedS = 10.0;  ///< that the flight recorder holds
  /// What the live line calls a tick's part of the run; at most 8 letters.
  using PhaseName = std::function<std::string(std::int64_t tick)>;

  /// \param opened  what is attended to
  /// \param device  what the servo runs: that of `opened`, or the same placed; both must outlive
  ///   this
  /// \param limits,rate_hz  as ServoOptions
  /// \param keys  whether q and the space bar are taken from standard input meanwhile
  AttendedRun(OpenedDevice& opened, device::HapticDevice& device,
              const device::SafetyLimits& limits, double rate_hz, bool keys = true);
  ~AttendedRun();
  AttendedRun(const AttendedRun&) = delete;
  AttendedRun& operator=(const AttendedRun&) = delete;

  /// Runs the servo in real time until it ends; meanwhile attends to window and keys, and shows a
  /// live line on standard error. After a stop was asked for, later runs do not begin.
  /// \param is_done  asked between; true: the force fades and the run ends
  /// \param sink  takes the samples; null: nobody does
  /// \return nothing if a stop had been asked for before
  std::optional<device::ServoReport> run(const PhaseName& phase, device::ForceSource& force,
                                         double seconds, const std::function<bool()>& is_done = {},
                                         device::SampleSink* sink = nullptr);

  /// Runs without force until the device is ready, and says what the person is to do. At once if
  /// it is. \throws DeviceError if it is not ready after `limit_s`, or a fault occurs
  void wait_until_ready(double limit_s);

  /// The keys + and - make every force stronger and weaker by tenths, from all of it down to one.
  void let_choose_strength() noexcept { chooses_strength_ = true; }

  [[nodiscard]] AttendedStop stop() const noexcept { return stop_; }
  [[nodiscard]] const device::SchedulingObtained& scheduling() const noexcept {
    return thread_.scheduling();
  }
  /// The last seconds of the last run, as CSV.
  [[nodiscard]] std::string flight_record() const;

 private:
  void take_keys();
  void take_strength(char key);
  void show(const PhaseName& phase);
  void end_line();

  OpenedDevice& opened_;
  device::HapticDevice& device_;
  device::ServoOptions options_;
  device::ServoControl control_;
  device::LatestValue<device::ServoState> state_;
  device::LatestValue<device::ServoParameters> parameters_;
  device::MotorHeat heat_;
  std::atomic<std::int64_t> heartbeat_{0};
  device::FlightRecorder recorder_;
  device::ServoThread thread_;
  device::Watchdog watchdog_;
  device::StopOnSignals signals_;
  std::optional<TerminalKeys> keys_;
  AttendedStop stop_ = AttendedStop::none;
  bool on_terminal_;
  bool chooses_strength_ = false;
  int strength_tenths_ = 10;
  std::int64_t shown_tick_ = 0;
  std::chrono::nanoseconds shown_at_{};
};

/// "device (link_lost)"; "none"
[[nodiscard]] std::string fault_text(const device::ServoReport& report);

}  // namespace touchtrial::app

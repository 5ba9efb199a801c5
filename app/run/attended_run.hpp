/// \file Runs of a device's servo with a person at the terminal: live numbers, keys, watchdog,
///   signals.
#pragma once

#include "app/terminal/terminal_keys.hpp"
#include "device/haptic_device.hpp"
#include "device/platform/stop_signals.hpp"
#include "device/safety/watchdog.hpp"
#include "device/servo/flight_recorder.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_thread.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace touchtrial::app {

/// Why a person or a signal stopped a run.
enum class AttendedStop {
  none,
  quit,     ///< q
  comfort,  ///< the space bar
  signal,   ///< Ctrl-C, or another signal that ends the program
};

/// Asks a question on standard error and reads the answer, one line of standard input. Input typed
/// at a terminal before the question appeared is discarded. An empty line counts only if Enter was
/// not pressed within the last second, so that a held key does not consent. Later lines stay in the
/// input.
/// \return nothing if a signal asked the program to end
/// \throws UsageError at the end of the input
[[nodiscard]] std::optional<std::string> attended_answer(const std::string& question);

/// Exerts no force and records no sample.
class NoForce final : public device::ForceSource, public device::SampleSink {
 public:
  [[nodiscard]] Vec3 force_n(const device::DeviceSample& /*sample*/) noexcept override {
    return {};
  }
  void record(const device::ServoSample& /*sample*/) noexcept override {}
};

/// The time within which a person can home a device.
inline constexpr double kReadyLimitS = 120.0;

/// One device with its servo, watchdog and keys. Belongs to the main thread.
class AttendedRun {
 public:
  static constexpr double kRecordedS = 10.0;  ///< length of the flight record
  /// The name of a tick's phase for the live line, at most 8 letters.
  using PhaseName = std::function<std::string(std::int64_t tick)>;

  /// \param device  must outlive this
  /// \param limits,rate_hz  as ServoOptions
  /// \param reads_keys  whether q and the space bar are read from standard input
  AttendedRun(device::HapticDevice& device, const device::SafetyLimits& limits, double rate_hz,
              bool reads_keys = true);
  ~AttendedRun();
  AttendedRun(const AttendedRun&) = delete;
  AttendedRun& operator=(const AttendedRun&) = delete;

  /// Runs the servo in real time until it ends. Handles keys, and shows a live line on standard
  /// error. No run starts after a stop.
  /// \param is_done  polled; once it returns true, the force fades and the run ends
  /// \return nothing if an earlier run was stopped
  std::optional<device::ServoReport> run(const PhaseName& phase, device::ForceSource& force,
                                         device::SampleSink& sink, double seconds,
                                         const std::function<bool()>& is_done = {});

  /// Instructs the person and runs without force until the device is ready. Returns at once if it
  /// is ready already. The person confirms the reset position of the arm by the key h, or by a line
  /// of standard input if no keys are read.
  /// \throws DeviceError if it is not ready after `limit_s`, or a fault occurs
  void wait_until_ready(double limit_s);

  /// Limits the force of later runs, within the limits of the constructor.
  /// \param max_n  > 0
  void limit_force(double max_n) noexcept;

  /// Makes the keys + and - scale all forces in steps of 10 %, from 10 % to 100 %.
  void enable_strength_keys() noexcept { has_strength_keys_ = true; }

  [[nodiscard]] AttendedStop stop() const noexcept { return stop_; }
  [[nodiscard]] const device::SchedulingObtained& scheduling() const noexcept {
    return thread_.scheduling();
  }
  /// The last seconds of the last run as CSV.
  [[nodiscard]] std::string flight_record() const;

 private:
  void handle_keys();
  void handle_strength_key(char key);
  void show(const PhaseName& phase);
  void clear_live_line();

  device::HapticDevice& device_;
  device::ServoOptions options_;
  double max_force_n_;  ///< the constructor's limit
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
  bool is_on_terminal_;
  bool has_strength_keys_ = false;
  int strength_tenths_ = 10;
  std::int64_t shown_tick_ = 0;
  std::chrono::nanoseconds shown_at_{};
};

}  // namespace touchtrial::app

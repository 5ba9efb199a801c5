/// \file The servo loop, which runs at 1 kHz or faster: read, compute the force, check, write, record.
#pragma once

#include "device/haptic_device.hpp"
#include "device/safety/safety_chain.hpp"
#include "device/servo/latest_value.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo/servo_control.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace touchtrial::device {

/// One tick of the servo at its usual rate.
constexpr std::chrono::nanoseconds kServoTick{1'000'000};
constexpr double kServoRateHz = 1000.0;
constexpr double kServoTickS = 1.0 / kServoRateHz;

/// Computes the servo's forces. Called on the servo thread: no heap, lock, log or I/O.
class ForceSource {
 public:
  virtual ~ForceSource() = default;
  /// \return the force on the hand in this state, N, in the plane frame
  [[nodiscard]] virtual Vec3 force_n(const DeviceSample& sample) noexcept = 0;
  /// Called after each force.
  /// \return whether the run should end with a fade, as if the hand were done
  [[nodiscard]] virtual bool is_done() const noexcept { return false; }
};

/// One tick: the stylus' position, and the sent force.
struct ServoSample {
  Vec3 position_mm;
  Vec3 force_n;           ///< without the device's support (HapticDevice::support_force_n)
  std::int64_t tick = 0;  ///< time since plane-on in ticks; overruns skip numbers
};

/// Receives the samples. Called on the servo thread, so it must not allocate.
class SampleSink {
 public:
  virtual ~SampleSink() = default;
  virtual void record(const ServoSample& sample) noexcept = 0;
};

struct ServoOptions {
  /// Ticks until time is up, >= 0.
  std::int64_t limit_ticks = 60'000;
  /// Ticks in which the force fades to zero when time is up, >= 0; recorded like the others.
  std::int64_t fade_ticks = 100;
  /// The device's own maximum and continuous force also apply.
  SafetyLimits limits{};
  double rate_hz = kServoRateHz;  ///< 1,000 to 10,000
};

/// The reason why the loop ended.
enum class ServoEnd {
  hand_stopped,  ///< the hand is done, by the device or by ServoControl::finish
  time_limit,    ///< time was up, and the force has faded
  comfort_stop,  ///< requested by a person; the force has faded
  fault,         ///< see SafetyFault
};

/// The lateness of ticks, from a DurationHistogram. After missed ticks it is measured from the
/// first missed one, so the worst lateness shows how long the loop stalled.
struct Lateness {
  double p50_us = 0.0;
  double p99_us = 0.0;
  double p999_us = 0.0;
  double worst_us = 0.0;
};

struct ServoReport {
  ServoEnd end = ServoEnd::fault;
  SafetyFault fault = SafetyFault::none;
  DeviceFault device_fault = DeviceFault::none;
  std::int64_t ticks = 0;          ///< recorded samples
  std::int64_t limited_ticks = 0;  ///< limited by the safety chain, or by the device itself
  std::int64_t contact_ticks = 0;  ///< with a force out of the plane
  std::int64_t overruns = 0;       ///< ticks missed because the loop stalled
  double force_limit_n = 0.0;  ///< the applied limit: the smaller of the options' and the device's
  /// Measured from the first tick to the last; 0 with fewer than two ticks. In virtual time,
  /// ServoOptions::rate_hz.
  double rate_hz = 0.0;
  Lateness lateness;  ///< zeros in virtual time
  /// The share of the commanded force that the device reports (DeviceSample::delivered_n): the
  /// best-fitting factor over ticks with at least 0.1 N; 0: no reports.
  double delivered_share = 0.0;
};

/// The loop's state for an observer.
struct ServoState {
  DeviceSample sample;
  Vec3 force_n;  ///< as sent, without the device's support
  SafetyVerdict verdict = SafetyVerdict::passed;
  std::int64_t tick = 0;
  double lateness_us = 0.0;  ///< of this tick
};

class DurationHistogram;
class FlightRecorder;

/// The heat of a device's motors, passed from run to run.
struct MotorHeat {
  double heat_n2 = 0.0;     ///< ThermalBudget::heat_n2 at that time
  ServoClock::Time when{};  ///< when the last run ended, by the clock of the runs
};

/// Parameters that other threads may change while the servo runs.
struct ServoParameters {
  /// Factor of every force, clamped to [0, 1]; NaN counts as 0. The servo follows a change within
  /// 100 ms, without a step.
  double force_share = 1.0;
};

/// The value of ServoHooks::heartbeat between runs.
inline constexpr std::int64_t kServoAtRest = -1;

/// Objects through which other threads observe or control the loop; null: none.
struct ServoHooks {
  ServoControl* control = nullptr;
  LatestValue<ServoState>* state = nullptr;  ///< set every tick, for one reader
  /// Counts ticks, for a Watchdog; kServoAtRest once the run has ended.
  std::atomic<std::int64_t>* heartbeat = nullptr;
  FlightRecorder* recorder = nullptr;     ///< records every tick, including the tick of a fault
  DurationHistogram* lateness = nullptr;  ///< the lateness of the run's ticks is added at the end
  MotorHeat* heat = nullptr;              ///< read at the beginning, written at the end
  /// Read atomically at every tick; one writer.
  LatestValue<ServoParameters>* parameters = nullptr;
};

/// Runs the loop until it ends; the calling thread becomes the servo thread. Tick i is due
/// i / rate_hz after the first. A loop that is late by a tick or more skips the missed ticks
/// instead of running them in a burst. Every force passes the safety chain; the last one written is
/// zero, and after a fault the device is halted. No allocation, lock or exception inside the loop.
/// \throws std::invalid_argument before the first tick if an option is out of its range
[[nodiscard]] ServoReport run_servo(HapticDevice& device, ForceSource& force, SampleSink& sink,
                                    const ServoOptions& options, ServoClock& clock,
                                    const ServoHooks& hooks = {});

/// The same in virtual time, as fast as possible; no tick is late.
/// \throws std::invalid_argument as run_servo
[[nodiscard]] ServoReport run_servo_in_virtual_time(HapticDevice& device, ForceSource& force,
                                                    SampleSink& sink, const ServoOptions& options);

/// \name Names of the servo's states in files and reports: lower case, with underscores
///@{
[[nodiscard]] std::string_view name_of(ServoEnd end) noexcept;
/// \return the names of the report's faults, for instance "device (link_lost)"; "none" without
///   a fault
[[nodiscard]] std::string fault_names(const ServoReport& report);
[[nodiscard]] std::string_view name_of(SafetyVerdict verdict) noexcept;
[[nodiscard]] std::string_view name_of(SafetyFault fault) noexcept;
[[nodiscard]] std::string_view name_of(DeviceFault fault) noexcept;
///@}

}  // namespace touchtrial::device

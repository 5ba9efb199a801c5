/// \file Conformance checks of plug-ins and built-in drivers: readings, zero forces, and timing.
///   Source: docs/devices/plugin.md, "Conformance".
#pragma once

#include "device/haptic_device.hpp"
#include "device/servo/servo_clock.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

/// The checks, in the order of execution and display.
enum class ConformanceId {
  library,  ///< only for plug-ins
  opening,
  description,
  memory,     ///< only for plug-ins
  staying,    ///< no fault without a cause
  numbering,  ///< sequence numbers of readings
  values,
  workspace,
  velocity,
  rate,
  gaps,          ///< between new readings
  unready_zero,  ///< zero force before the device is ready
  rest_zero,     ///< zero force while the servo sends zero
  pushing,       ///< the motors receive the servo's force
  lapsing,       ///< zero force after the servo's last write
  halting,
  rearming,
  closing_zero,
  opening_twice,
  reopening,
  calls,  ///< only for plug-ins
};

enum class ConformanceOutcome {
  not_observed,  ///< the check was not possible; no statement about the driver
  passed,
  failed,
};

struct ConformanceCheck {
  ConformanceId id;
  std::string_view name;     ///< for instance "zero after halt"
  std::string_view meaning;  ///< the requirement, one sentence
  ConformanceOutcome outcome = ConformanceOutcome::not_observed;
  std::string finding;  ///< measured numbers, the failure, or why it was not observed
};

/// The check that a faulty driver failed, and how.
struct DriverFailure {
  ConformanceId id;
  std::string details;
};

/// The driver under check.
struct ConformanceSubject {
  /// Opens the device again; throws DeviceError on failure.
  std::function<std::unique_ptr<HapticDevice>()> open;
  /// \return the motors' force command of the last opened device, device frame, N, even after
  ///   closing; nothing if unknown. Null: not observable.
  std::function<std::optional<Vec3>()> motor_force_n;
  /// \return the check that a faulty device failed. Null: derived from DeviceFault.
  std::function<std::optional<DriverFailure>(const HapticDevice&)> find_failure;
  bool can_open_twice = true;  ///< false for a test rig that allows only one opening
};

struct ConformanceOptions {
  double seconds = 2.0;          ///< observation of readings, >= 0.2
  double ready_limit_s = 120.0;  ///< time for a person to make the device ready, > 0
  int reopenings = 3;            ///< >= 0
  /// Whether forces of kPushN may be sent. They bypass the safety chain, because the checks test
  /// the driver below it.
  bool pushes = false;
  /// Whether the device follows the clock. If not, checks of timing report numbers without a
  /// verdict.
  bool judges_time = true;
  /// Whether the durations of a plug-in's calls, which are measured in real time, get a verdict.
  bool judges_calls = true;
  /// Called at every tick; returns whether to end at once. Null: never.
  std::function<bool()> stopped;
  /// Called with each opened device; the result is released before the device is closed. Null: not
  /// called.
  std::function<std::shared_ptr<void>(HapticDevice&)> guard;
  /// Called with the instruction that a person must follow before the device is ready. Null: not
  /// called.
  std::function<void(DeviceReadiness)> advise;

  static constexpr double kPushN = 0.3;
  /// Smaller forces count as zero.
  static constexpr double kZeroN = 0.01;
  /// The time limit for zero force after the servo's last write, halt and closing: 10 ms, plus 20
  /// ms for the ticks of device and observer.
  static constexpr double kZeroWithinS = 0.030;
  /// The safety chain rejects older readings as stale.
  static constexpr double kMaxGapS = 0.010;
};

/// Runs the checks on the calling thread; the clock paces them at 1 kHz.
/// \return one entry for each check; checks only for plug-ins are included only if they failed
[[nodiscard]] std::vector<ConformanceCheck> check_conformance(const ConformanceSubject& subject,
                                                              ServoClock& clock,
                                                              const ConformanceOptions& options);

/// Collects the outcomes of checks; callers can add their own.
class ConformanceRecord {
 public:
  void pass(ConformanceId id, std::string finding = {});
  /// Only the first failure of a check is stored.
  void fail(ConformanceId id, std::string finding);
  /// Records why a check was not observed; no effect if it has an entry.
  void set_not_observed(ConformanceId id, std::string reason);
  /// The same for all checks without an entry.
  void set_remaining_not_observed(const std::string& reason, bool with_plugin_checks);
  [[nodiscard]] bool has(ConformanceId id) const { return entries_.count(id) > 0; }
  [[nodiscard]] bool failed(ConformanceId id) const;
  void add(const std::vector<ConformanceCheck>& checks);
  /// \param with_plugin_checks  whether to include plug-in checks that have no entry
  /// \return the checks, in order
  [[nodiscard]] std::vector<ConformanceCheck> checks(bool with_plugin_checks) const;

 private:
  struct Entry {
    ConformanceOutcome outcome = ConformanceOutcome::not_observed;
    std::string finding;
  };
  std::map<ConformanceId, Entry> entries_;
};

/// \return whether readings were observed and no check failed
[[nodiscard]] bool conforms(const std::vector<ConformanceCheck>& checks) noexcept;

[[nodiscard]] std::string_view name_of(ConformanceOutcome outcome) noexcept;

}  // namespace touchtrial::device

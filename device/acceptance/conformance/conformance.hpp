/// \file Checks of a device driver, for plug-in authors and for the built-in drivers: readings,
///   zero forces, and timing. Source: docs/devices/plugin.md, "Conformance".
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

/// In the order of execution and display.
enum class ConformanceId {
  library,  ///< only for plug-ins
  opening,
  description,
  memory,  ///< only for plug-ins
  staying,
  numbering,
  values,
  workspace,
  velocity,
  rate,
  gaps,
  unready_zero,
  rest_zero,
  pushing,
  lapsing,
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
  std::string_view name;     ///< "zero after halt"
  std::string_view meaning;  ///< a sentence on what a passing driver does
  ConformanceOutcome outcome = ConformanceOutcome::not_observed;
  std::string finding;  ///< numbers, the failure, or why it was not observed
};

/// A failure with more detail than a fault's name.
struct ConformanceBlame {
  ConformanceId id;
  std::string words;
};

/// The driver under check.
struct ConformanceSubject {
  /// Opens the device again; throws DeviceError on failure.
  std::function<std::unique_ptr<HapticDevice>()> open;
  /// \return the force command of the motors of the last opened device, device frame, N, also after
  ///   closing; nothing if unknown. Null: not observable.
  std::function<std::optional<Vec3>()> motor_force_n;
  /// The check that a faulty device failed; null: judged by DeviceFault.
  std::function<std::optional<ConformanceBlame>(const HapticDevice&)> blame;
  bool can_open_twice = true;  ///< false: `open` is a test rig that allows one opening
};

struct ConformanceOptions {
  double seconds = 2.0;          ///< observation of readings, >= 0.2
  double ready_limit_s = 120.0;  ///< for a person to make the device ready, > 0
  int reopenings = 3;            ///< >= 0
  /// Whether forces of kPushN may be sent. The checks send them directly to the driver, bypassing
  /// the safety chain, because they test what is below it.
  bool pushes = false;
  /// Whether the clock's time applies to the device. If not, checks of timing report numbers
  /// without a verdict.
  bool judges_time = true;
  /// Whether the durations of a plug-in's calls, which are always of real time, are judged.
  bool judges_calls = true;
  /// Polled at every tick: whether to end at once. Null: never.
  std::function<bool()> stopped;
  /// Called with a device that may receive force; its result lives as long as the device. Null: not
  /// called.
  std::function<std::shared_ptr<void>(HapticDevice&)> guard;
  /// Called with the instruction that a person must follow before the device is ready. Null: not
  /// called.
  std::function<void(DeviceReadiness)> advise;

  static constexpr double kPushN = 0.3;
  /// Smaller forces count as zero.
  static constexpr double kZeroN = 0.01;
  /// The time limit for zero force after the servo's last write, halt and closing: 10 ms, and twice
  /// that for the device's own ticks and those of the observer.
  static constexpr double kZeroWithinS = 0.030;
  /// The safety chain treats older readings as stale.
  static constexpr double kMaxGapS = 0.010;
};

/// Runs the checks on the calling thread; the clock paces them at 1 kHz. Checks that need more than
/// a HapticDevice are not observed.
/// \return one entry for each check, without those only of plug-ins unless they failed
[[nodiscard]] std::vector<ConformanceCheck> check_conformance(const ConformanceSubject& subject,
                                                              ServoClock& clock,
                                                              const ConformanceOptions& options);

/// Collects the outcomes of checks; callers can add their own.
class ConformanceRecord {
 public:
  void pass(ConformanceId id, std::string finding = {});
  /// Only the first failure of a check is stored.
  void fail(ConformanceId id, std::string finding);
  /// Sets why a check was not observed; no effect if it has an outcome.
  void leave(ConformanceId id, std::string reason);
  /// Does so for all checks without outcome or reason, with or without those of plug-ins.
  void leave_rest(const std::string& reason, bool of_plugin);
  [[nodiscard]] bool has(ConformanceId id) const { return entries_.count(id) > 0; }
  [[nodiscard]] bool failed(ConformanceId id) const;
  void add(const std::vector<ConformanceCheck>& checks);
  /// In order; with or without plug-in checks that have no entry.
  [[nodiscard]] std::vector<ConformanceCheck> checks(bool of_plugin) const;

 private:
  struct Entry {
    ConformanceOutcome outcome = ConformanceOutcome::not_observed;
    std::string finding;
  };
  std::map<ConformanceId, Entry> entries_;
};

/// \return whether readings were observed, and no check failed
[[nodiscard]] bool conforms(const std::vector<ConformanceCheck>& checks) noexcept;

/// "passed", "failed" or "not_observed"
[[nodiscard]] std::string_view name_of(ConformanceOutcome outcome) noexcept;

}  // namespace touchtrial::device

/// \file Checks of a device's driver, for its author and for every driver of the program: readings,
/// zero forces, and time. Source: docs/devices/plugin.md, "Conformance".
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

/// In the order in which they are made and shown.
enum class ConformanceId {
  library,  ///< of plug-ins alone
  opening,
  description,
  memory,  ///< of plug-ins alone
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
  calls,  ///< of plug-ins alone
};

enum class ConformanceOutcome {
  not_observed,  ///< the check could not be made; says nothing about the driver
  passed,
  failed,
};

struct ConformanceCheck {
  ConformanceId id;
  std::string_view name;     ///< "zero after halt"
  std::string_view meaning;  ///< a sentence: what a driver that passes does
  ConformanceOutcome outcome = ConformanceOutcome::not_observed;
  std::string finding;  ///< numbers, what failed, or why it was not observed
};

/// What a driver is blamed for by somebody who knows more than a fault's name.
struct ConformanceBlame {
  ConformanceId id;
  std::string words;
};

/// The driver under check.
struct ConformanceSubject {
  /// Opens the device anew; throws DeviceError if it cannot.
  std::function<std::unique_ptr<HapticDevice>()> open;
  /// \return the force that the motors of the device opened last are told, device frame, N, after
  ///   closing too; nothing if it is not known. Null: nobody can see it.
  std::function<std::optional<Vec3>()> motor_force_n;
  /// The check that a faulty device failed; null: judged by DeviceFault.
  std::function<std::optional<ConformanceBlame>(const HapticDevice&)> blame;
  bool can_open_twice = true;  ///< false: `open` is a rig that cannot be asked
};

struct ConformanceOptions {
  double seconds = 2.0;          ///< of watching readings, >= 0.2
  double ready_limit_s = 120.0;  ///< for a person to make the device ready, > 0
  int reopenings = 3;            ///< >= 0
  /// Whether forces of kPushN may be sent. The checks send them to the driver itself, below the
  /// safety chain, as they look at what is below it.
  bool pushes = false;
  /// Whether the clock's time means anything for the device. If it does not, checks of time tell
  /// their numbers and judge nothing.
  bool judges_time = true;
  /// Whether the durations of a plug-in's calls, which are always of real time, are judged.
  bool judges_calls = true;
  /// Asked at every tick: whether to end at once. Null: never.
  std::function<bool()> stopped;
  /// Called with a device that may be sent force; what it returns lives as long as the device.
  /// Null: nothing.
  std::function<std::shared_ptr<void>(HapticDevice&)> guard;
  /// Told what a person has to do before the device is ready. Null: nobody is told.
  std::function<void(DeviceReadiness)> advise;

  static constexpr double kPushN = 0.3;
  /// What is less than this counts as zero.
  static constexpr double kZeroN = 0.01;
  /// Forces are zero so long after the servo's last write, halt and closing: 10 ms, and twice that
  /// for the device's own ticks and those of the observer.
  static constexpr double kZeroWithinS = 0.030;
  /// The safety chain calls older readings stale.
  static constexpr double kLongestGapS = 0.010;
};

/// Runs the checks on the calling thread; the clock paces them at 1 kHz. Checks that need more than
/// a HapticDevice are not observed.
/// \return one entry for each check, except those of plug-ins alone unless there is blame for them
[[nodiscard]] std::vector<ConformanceCheck> check_conformance(const ConformanceSubject& subject,
                                                              ServoClock& clock,
                                                              const ConformanceOptions& options);

/// The outcomes of checks while they are made, for those who make some of their own.
class ConformanceRecord {
 public:
  void pass(ConformanceId id, std::string finding = {});
  /// The first failure of a check stays.
  void fail(ConformanceId id, std::string finding);
  /// Why it was not observed; says nothing about a check that has an outcome.
  void leave(ConformanceId id, std::string reason);
  /// Says so of all that have neither outcome nor reason, with or without those of plug-ins.
  void leave_rest(const std::string& reason, bool of_plugin);
  [[nodiscard]] bool has(ConformanceId id) const { return entries_.count(id) > 0; }
  [[nodiscard]] bool failed(ConformanceId id) const;
  void add(const std::vector<ConformanceCheck>& checks);
  /// In order; with or without those of plug-ins that have no entry.
  [[nodiscard]] std::vector<ConformanceCheck> checks(bool of_plugin) const;

 private:
  struct Entry {
    ConformanceOutcome outcome = ConformanceOutcome::not_observed;
    std::string finding;
  };
  std::map<ConformanceId, Entry> entries_;
};

/// \return whether readings were watched, and no check failed
[[nodiscard]] bool conforms(const std::vector<ConformanceCheck>& checks) noexcept;

/// "passed", "failed" or "not_observed"
[[nodiscard]] std::string_view name_of(ConformanceOutcome outcome) noexcept;

}  // namespace touchtrial::device

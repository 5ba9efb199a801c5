/// \file What a monitor says of a device and its servo, in words for whoever stands beside it.
#pragma once

#include "device/servo/servo.hpp"

#include <optional>
#include <string>

namespace touchtrial::app {

enum class StateTone { running, waiting, stopped, fault };

struct StateLine {
  StateTone tone = StateTone::waiting;
  std::string text;  ///< one line
};

/// What the state line needs to know.
struct MonitoredState {
  bool ready = true;  ///< of the newest sample
  device::DeviceReadiness readiness = device::DeviceReadiness::ready;
  bool wall_on = false;
  bool wall_waits = false;
  std::optional<device::ServoReport> ended = std::nullopt;  ///< nothing while the servo runs
};

[[nodiscard]] StateLine state_line(const MonitoredState& state);

/// What was wrong, and what to do about it: "the device no longer answers; check its cable and
/// power".
[[nodiscard]] std::string fault_in_words(const device::ServoReport& report);

/// What the person has to do before force may be sent; empty if nothing.
[[nodiscard]] std::string readiness_in_words(device::DeviceReadiness readiness);

}  // namespace touchtrial::app

#include "device/servo/servo_names.hpp"

namespace touchtrial::device {

// No default in these: the compiler names a value that is new and has no word yet.

std::string_view name_of(ServoEnd end) noexcept {
  switch (end) {
    case ServoEnd::hand_stopped:
      return "hand_stopped";
    case ServoEnd::time_limit:
      return "time_limit";
    case ServoEnd::comfort_stop:
      return "comfort_stop";
    case ServoEnd::fault:
      break;
  }
  return "fault";
}

std::string_view name_of(SafetyVerdict verdict) noexcept {
  switch (verdict) {
    case SafetyVerdict::passed:
      return "passed";
    case SafetyVerdict::limited:
      return "limited";
    case SafetyVerdict::fault:
      break;
  }
  return "fault";
}

std::string_view name_of(SafetyFault fault) noexcept {
  switch (fault) {
    case SafetyFault::none:
      return "none";
    case SafetyFault::not_finite:
      return "not_finite";
    case SafetyFault::emergency_stop:
      return "emergency_stop";
    case SafetyFault::not_ready:
      return "not_ready";
    case SafetyFault::overspeed:
      return "overspeed";
    case SafetyFault::stale_sample:
      return "stale_sample";
    case SafetyFault::stalled:
      return "stalled";
    case SafetyFault::device:
      break;
  }
  return "device";
}

std::string_view name_of(DeviceFault fault) noexcept {
  switch (fault) {
    case DeviceFault::none:
      return "none";
    case DeviceFault::link_lost:
      return "link_lost";
    case DeviceFault::bad_data:
      return "bad_data";
    case DeviceFault::warm_motors:
      return "warm_motors";
    case DeviceFault::limit_passed:
      return "limit_passed";
    case DeviceFault::driver:
      break;
  }
  return "driver";
}

std::string_view name_of(SchedulingPolicy policy) noexcept {
  return policy == SchedulingPolicy::fifo ? "fifo" : "other";
}

}  // namespace touchtrial::device

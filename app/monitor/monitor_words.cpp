#include "app/monitor/monitor_words.hpp"

namespace touchtrial::app {
namespace {

std::string device_fault_in_words(device::DeviceFault fault) {
  switch (fault) {
    case device::DeviceFault::link_lost:
      return "the device no longer answers; check its cable and power";
    case device::DeviceFault::bad_data:
      return "the device answers, but not sense; plug it in anew";
    case device::DeviceFault::warm_motors:
      return "the motors are too warm; let them cool down";
    case device::DeviceFault::limit_passed:
      return "the vendor's library stopped it: too much force or speed";
    case device::DeviceFault::driver:
      return "the vendor's library or the system failed; see touchtrial device list";
    case device::DeviceFault::none:
      break;
  }
  return "the device reported a fault";
}

}  // namespace

std::string fault_in_words(const device::ServoReport& report) {
  switch (report.fault) {
    case device::SafetyFault::not_finite:
      return "a position or force was no number";
    case device::SafetyFault::emergency_stop:
      return "emergency stop";
    case device::SafetyFault::not_ready:
      return "the device lost its homing while force was on";
    case device::SafetyFault::overspeed:
      return "the stylus moved faster than a hand does";
    case device::SafetyFault::stale_sample:
      return "the device gives no new readings; check its cable";
    case device::SafetyFault::stalled:
      return "the servo stood still; close other programs";
    case device::SafetyFault::device:
      return device_fault_in_words(report.device_fault);
    case device::SafetyFault::none:
      break;
  }
  return device_fault_in_words(report.device_fault);
}

std::string readiness_in_words(device::DeviceReadiness readiness) {
  switch (readiness) {
    case device::DeviceReadiness::needs_homing:
      return "move the handle through its whole range until every axis is homed";
    case device::DeviceReadiness::needs_inkwell:
      return "put the stylus into its inkwell";
    case device::DeviceReadiness::needs_calibration:
      return "run the vendor's own calibration";
    case device::DeviceReadiness::ready:
      break;
  }
  return "";
}

StateLine state_line(const MonitoredState& state) {
  if (state.ended && state.ended->end == device::ServoEnd::fault) {
    return {StateTone::fault, "Fault: " + fault_in_words(*state.ended) + ". Force is zero."};
  }
  if (state.ended) {
    const bool by_person = state.ended->end == device::ServoEnd::comfort_stop;
    return {StateTone::stopped,
            by_person ? "Stopped. Force is zero." : "Ended: the hand is done. Force is zero."};
  }
  if (state.readiness != device::DeviceReadiness::ready) {
    return {StateTone::waiting, "Waiting: " + readiness_in_words(state.readiness) + "."};
  }
  if (!state.ready) return {StateTone::waiting, "Waiting: the device is not ready. Force is zero."};
  if (!state.wall_on) return {StateTone::running, "Running, no force asked for."};
  if (state.wall_waits) {
    return {StateTone::running, "Running. The wall waits until the stylus is in front of it."};
  }
  return {StateTone::running, "Running, wall on."};
}

}  // namespace touchtrial::app

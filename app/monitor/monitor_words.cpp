#include "app/monitor/monitor_words.hpp"

namespace touchtrial {
namespace {

std::string device_fault_in_words(DeviceFault fault) {
  switch (fault) {
    case DeviceFault::link_lost:
      return "the device no longer answers; check its cable and power";
    case DeviceFault::bad_data:
      return "the device answers, but not sense; plug it in anew";
    case DeviceFault::warm_motors:
      return "the motors are too warm; let them cool down";
    case DeviceFault::limit_passed:
      return "the vendor's library stopped it: too much force or speed";
    case DeviceFault::driver:
      return "the vendor's library or the system failed; see touchtrial device list";
    case DeviceFault::none:
      break;
  }
  return "the device reported a fault";
}

}  // namespace

std::string fault_in_words(const ServoReport& report) {
  switch (report.fault) {
    case SafetyFault::not_finite:
      return "a position or force was no number";
    case SafetyFault::emergency_stop:
      return "emergency stop";
    case SafetyFault::not_ready:
      return "the device lost its homing while force was on";
    case SafetyFault::overspeed:
      return "the stylus moved faster than a hand does";
    case SafetyFault::stale_sample:
      return "the device gives no new readings; check its cable";
    case SafetyFault::stalled:
      return "the servo stood still; close other programs";
    case SafetyFault::device:
      return device_fault_in_words(report.device_fault);
    case SafetyFault::none:
      break;
  }
  return device_fault_in_words(report.device_fault);
}

std::string readiness_in_words(DeviceReadiness readiness) {
  switch (readiness) {
    case DeviceReadiness::needs_homing:
      return "move the handle through its whole range until every axis is homed";
    case DeviceReadiness::needs_inkwell:
      return "put the stylus into its inkwell";
    case DeviceReadiness::needs_calibration:
      return "run the vendor's own calibration";
    case DeviceReadiness::ready:
      break;
  }
  return "";
}

StateLine state_line(const MonitoredState& state) {
  if (state.ended && state.ended->end == ServoEnd::fault) {
    return {StateTone::fault, "Fault: " + fault_in_words(*state.ended) + ". Force is zero."};
  }
  if (state.ended) {
    const bool by_person = state.ended->end == ServoEnd::comfort_stop;
    return {StateTone::stopped,
            by_person ? "Stopped. Force is zero." : "Ended: the hand is done. Force is zero."};
  }
  if (state.readiness != DeviceReadiness::ready) {
    return {StateTone::waiting, "Waiting: " + readiness_in_words(state.readiness) + "."};
  }
  if (!state.ready) return {StateTone::waiting, "Waiting: the device is not ready. Force is zero."};
  if (!state.wall_on) return {StateTone::running, "Running, no force asked for."};
  if (state.wall_waits) {
    return {StateTone::running, "Running. The wall waits until the stylus is in front of it."};
  }
  return {StateTone::running, "Running, wall on."};
}

}  // namespace touchtrial

#include "app/device_words.hpp"

namespace touchtrial::app {
namespace {

std::string device_fault_in_words(device::DeviceFault fault) {
  switch (fault) {
    case device::DeviceFault::link_lost:
      return "the device no longer answers; check its cable and power";
    case device::DeviceFault::bad_data:
      return "the device sends invalid data; unplug it and plug it in again";
    case device::DeviceFault::warm_motors:
      return "the motors are too warm; let them cool down";
    case device::DeviceFault::limit_passed:
      return "the vendor's library stopped the device: too much force or speed";
    case device::DeviceFault::driver:
      return "the vendor's library or the system failed; see touchtrial device list";
    case device::DeviceFault::none:
      break;
  }
  return "the device reported a fault";
}

}  // namespace

std::string fault_names(const device::ServoReport& report) {
  std::string names(device::name_of(report.fault));
  if (report.device_fault != device::DeviceFault::none) {
    names += " (" + std::string(device::name_of(report.device_fault)) + ")";
  }
  return names;
}

std::string fault_in_words(const device::ServoReport& report) {
  switch (report.fault) {
    case device::SafetyFault::not_finite:
      return "a position or force was not a number";
    case device::SafetyFault::emergency_stop:
      return "emergency stop";
    case device::SafetyFault::not_ready:
      return "the device lost its homing while force was on";
    case device::SafetyFault::overspeed:
      return "the stylus moved faster than a hand can";
    case device::SafetyFault::stale_sample:
      return "the device sends no new positions; check its cable";
    case device::SafetyFault::frozen_encoders:
      return "the device's position stood still while somebody pressed; its encoders may have "
             "stopped, "
             "so switch it off and on and calibrate it";
    case device::SafetyFault::stalled:
      return "the servo stalled; close other programs";
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
      return "move the handle slowly through its whole range until every axis is homed";
    case device::DeviceReadiness::needs_inkwell:
      return "put the stylus into its inkwell, wait, and take it out again";
    case device::DeviceReadiness::needs_reset:
      return "put the arm at its reset position, with all its links at right angles, and hold it "
             "still";
    case device::DeviceReadiness::needs_calibration:
      return "calibrate it as its page in docs/devices says: the rest position, or the vendor's "
             "own "
             "calibration";
    case device::DeviceReadiness::needs_force_on:
      return "press the force button at the device, so that its light is on";
    case device::DeviceReadiness::ready:
      break;
  }
  return "";
}

device::RenderedStiffness rendered_stiffness(const engine::RenderingOptions& rendering) {
  return {rendering.stiffness_n_per_mm, rendering.texture_stiffness_n_per_mm,
          rendering.damping_n_s_per_mm};
}

}  // namespace touchtrial::app

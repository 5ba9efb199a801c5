#include "app/commands/device_words.hpp"

#include "core/named.hpp"

#include <array>

namespace touchtrial::app {
namespace {

using device::DeviceFault;
using device::DeviceReadiness;
using device::SafetyFault;

constexpr auto kDeviceFaults = std::to_array<Named<DeviceFault>>(
    {{"the device reported a fault", DeviceFault::none},
     {"the device no longer answers; check its cable and power", DeviceFault::link_lost},
     {"the device sends invalid data; unplug it and plug it in again", DeviceFault::bad_data},
     {"the motors are too warm; let them cool down", DeviceFault::warm_motors},
     {"the vendor's library stopped the device: too much force or speed",
      DeviceFault::limit_passed},
     {"the vendor's library or the system failed; see touchtrial device list",
      DeviceFault::driver}});

/// Faults that the device does not report itself.
constexpr auto kSafetyFaults = std::to_array<Named<SafetyFault>>(
    {{"a position or force was not a number", SafetyFault::not_finite},
     {"emergency stop", SafetyFault::emergency_stop},
     {"the device lost its homing while force was on", SafetyFault::not_ready},
     {"the stylus moved faster than a hand can", SafetyFault::overspeed},
     {"the device sends no new positions; check its cable", SafetyFault::stale_sample},
     {"the device's position did not change under pressure; its encoders may have stopped, so "
      "switch it off and on and calibrate it",
      SafetyFault::frozen_encoders},
     {"the servo stalled; close other programs", SafetyFault::stalled}});

constexpr auto kReadiness = std::to_array<Named<DeviceReadiness>>(
    {{"", DeviceReadiness::ready},
     {"move the handle slowly through its whole range until every axis is homed",
      DeviceReadiness::needs_homing},
     {"put the stylus into its inkwell, wait, and take it out again",
      DeviceReadiness::needs_inkwell},
     {"put the arm at its reset position, with all its links at right angles, and hold it still",
      DeviceReadiness::needs_reset},
     {"calibrate it as described on its page in docs/devices: the rest position, or the vendor's "
      "own calibration",
      DeviceReadiness::needs_calibration},
     {"press the force button on the device, so that its light is on",
      DeviceReadiness::needs_force_on}});

}  // namespace

std::string fault_in_words(const device::ServoReport& report) {
  const bool is_of_device =
      report.fault == SafetyFault::device || report.fault == SafetyFault::none;
  return std::string(is_of_device ? name_in(kDeviceFaults, report.device_fault)
                                  : name_in(kSafetyFaults, report.fault));
}

std::string readiness_in_words(device::DeviceReadiness readiness) {
  return std::string(name_in(kReadiness, readiness));
}

device::RenderedStiffness rendered_stiffness(const engine::RenderingOptions& rendering) {
  return {rendering.stiffness_n_per_mm, rendering.texture_stiffness_n_per_mm,
          rendering.damping_n_s_per_mm};
}

}  // namespace touchtrial::app

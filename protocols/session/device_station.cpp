#include "protocols/session/device_station.hpp"

#include "core/errors.hpp"
#include "core/named.hpp"
#include "device/platform/stop_signals.hpp"
#include "device/servo/servo.hpp"

#include <array>
#include <stdexcept>
#include <utility>

namespace touchtrial::session {
namespace {

std::string readiness_problem(device::DeviceReadiness readiness) {
  using enum device::DeviceReadiness;
  static constexpr auto kNames = std::to_array<Named<device::DeviceReadiness>>(
      {{"the device is not homed; move its handle through its whole range", needs_homing},
       {"the device is not calibrated; put the stylus into its inkwell", needs_inkwell},
       {"the device is not calibrated; hold its arm still at the reset position, with all links at "
        "right angles, and press h",
        needs_reset},
       {"the device is not calibrated; put it at its rest position, or run the vendor's "
        "calibration",
        needs_calibration},
       {"force is switched off at the device; press its force button", needs_force_on},
       {"", ready}});
  return std::string(name_in(kNames, readiness));
}

std::string identity_of(const device::DeviceInfo& device) {
  return device.name + (device.serial.empty() ? "" : " " + device.serial);
}

std::array<double, 3> axes_of(Vec3 scale) {
  return {scale.x, scale.y, scale.z};
}

std::string text_of(const device::SchedulingObtained& scheduling) {
  std::string text(device::name_of(scheduling.policy));
  if (scheduling.priority > 0) text += " " + std::to_string(scheduling.priority);
  return text + (scheduling.memory_locked ? ", memory locked" : ", memory not locked");
}

}  // namespace

DeviceStation::DeviceStation(Open open, const std::optional<device::PlanePlacement>& placement,
                             Attendant& attendant)
    : open_(std::move(open)), placement_(placement), attendant_(attendant) {}

SupplyState DeviceStation::make_ready() {
  if (device::StopOnSignals::stop_requested()) return SupplyState::stopped;
  const std::string problem = missing_condition();
  if (problem.empty() && armed_) return SupplyState::ready;
  const Attendant::Reply reply = attendant_.poll(problem);
  if (reply == Attendant::Reply::stop) return SupplyState::stopped;
  if (reply == Attendant::Reply::at_reset && device_) device_->calibrate();
  if (reply != Attendant::Reply::arm || !problem.empty()) return SupplyState::not_yet;
  device_->rearm();
  armed_ = true;
  return SupplyState::ready;
}

std::string DeviceStation::missing_condition() {
  if (device_ && device_->fault() != device::DeviceFault::none) close();
  if (!device_) {
    std::string problem = open();
    if (!problem.empty()) return problem;
  }
  return readiness_problem(device_->readiness());
}

std::string DeviceStation::open() try {
  device_ = open_();
  // No force is allowed before a person consents.
  device_->halt();
  const device::DeviceInfo info = device_->info();
  if (!first_info_) first_info_ = info;
  if (identity_of(info) != identity_of(*first_info_)) {
    close();
    return identity_of(info) + " is not the device with which the session began; connect " +
           identity_of(*first_info_);
  }
  if (placement_) placed_device_.emplace(*device_, *placement_);
  return "";
} catch (const Error& error) {
  // After a power cut the device, or even the file of its firmware, may be missing: a person can
  // restore either.
  close();
  return error.what();
}

void DeviceStation::close() noexcept {
  placed_device_.reset();
  device_.reset();
  armed_ = false;
}

device::HapticDevice& DeviceStation::device() {
  if (!device_) throw std::logic_error("DeviceStation: no device is open");
  if (placed_device_) return *placed_device_;
  return *device_;
}

const device::DeviceInfo& DeviceStation::info() const {
  if (!first_info_) throw std::logic_error("DeviceStation: no device has been opened");
  return *first_info_;
}

void describe_station(record::SessionOpening& opening, const device::DeviceInfo& device,
                      const device::SchedulingObtained& scheduling, double rate_hz,
                      const std::string& certificate) {
  opening.device = device.name;
  opening.device_serial = device.serial;
  opening.simulated = device.simulated;
  opening.station = record::StationRecord{.model = device.model,
                                          .firmware = device.firmware,
                                          .max_force_n = device.max_force_n,
                                          .visual = device.visual,
                                          .rate_hz = rate_hz,
                                          .scheduling = text_of(scheduling),
                                          .calibration = certificate,
                                          .force_scale = axes_of(device.scale.force),
                                          .length_scale = axes_of(device.scale.length)};
}

}  // namespace touchtrial::session

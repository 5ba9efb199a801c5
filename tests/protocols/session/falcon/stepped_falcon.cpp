#include "protocols/session/falcon/stepped_falcon.hpp"

#include "device/falcon/usb_falcon.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::device::falcon {
namespace {

constexpr Vec3 kRestMm = {0.0, 15.0, 0.0};
/// More than homing takes.
constexpr int kHomingSteps = 1200;

std::unique_ptr<FalconDevice> open_in_lockstep(const device::FalconSettings& settings,
                                               Lockstep& lockstep) {
  FalconOptions options;
  options.pace = lockstep.pace();
  options.scheduling = {device::SchedulingPolicy::other, 0, false};
  return std::make_unique<FalconDevice>(open_usb_falcon(settings.serial), settings,
                                        std::move(options));
}

}  // namespace

EmulatedFalcon::EmulatedFalcon(const device::PlanePlacement& placement) : hand(placement, kRestMm) {
  emulator.set_hand([this](Vec3 force_n) { return hand.tick(force_n); });
}

void EmulatedFalcon::unplug() {
  plugged = false;
  usb.unplug();
  emulator.unplug();
}

void EmulatedFalcon::plug() {
  emulator.replug(false);
  usb.plug();
  plugged = true;
}

SteppedFalcon::SteppedFalcon(const device::FalconSettings& settings,
                             std::function<void()> before_read)
    : falcon_(open_in_lockstep(settings, lockstep_)), before_read_(std::move(before_read)) {}

device::DeviceStatus SteppedFalcon::read(device::DeviceSample& sample) noexcept {
  if (before_read_) before_read_();
  lockstep_.step();
  return falcon_->read(sample);
}

device::DeviceStatus SteppedFalcon::write(Vec3 force_n) noexcept {
  return falcon_->write(force_n);
}

session::Attendant::Says Experimenter::attend(const std::string& need) {
  // What the motors of an unplugged Falcon do is unknown, and beyond anyone's reach.
  if (falcon_.plugged) strongest_n = std::max(strongest_n, norm(falcon_.emulator.force_n()));
  if (need.empty()) {
    ++consents;
    return Says::arm;
  }
  needs.push_back(need);
  if (!falcon_.plugged) {
    falcon_.plug();
  } else if (device_ != nullptr) {
    falcon_.hand.home();
    device_->steps(kHomingSteps);
  }
  return Says::wait;
}

}  // namespace touchtrial::device::falcon

#include "device/dhd/dhd_device.hpp"

#include "device/dhd/dhd_loop.hpp"
#include "device/dhd/dhd_session.hpp"
#include "device/platform/realtime.hpp"

namespace touchtrial::device {

/// The loop ends before the session that it talks through.
struct DhdDevice::Running {
  explicit Running(const DhdSettings& settings) : session(settings), info(session.info()) {
    session.configure();
    loop = std::make_unique<dhd::Loop>(session.api(), session.device());
  }

  dhd::Session session;
  DeviceInfo info;
  std::unique_ptr<dhd::Loop> loop;
};

DhdDevice::DhdDevice(const DhdSettings& settings) : running_(std::make_unique<Running>(settings)) {}

DhdDevice::~DhdDevice() = default;

DeviceInfo DhdDevice::info() const {
  return running_->info;
}

DeviceStatus DhdDevice::read(DeviceSample& sample) noexcept {
  return running_->loop->link().read(sample);
}

DeviceStatus DhdDevice::write(Vec3 force_n) noexcept {
  return running_->loop->link().write(force_n, monotonic_now());
}

void DhdDevice::halt() noexcept {
  running_->loop->link().halt();
}

void DhdDevice::rearm() noexcept {
  running_->loop->link().rearm();
}

DeviceFault DhdDevice::fault() const noexcept {
  return running_->loop->link().fault();
}

DeviceReadiness DhdDevice::readiness() const noexcept {
  return running_->loop->readiness();
}

}  // namespace touchtrial::device

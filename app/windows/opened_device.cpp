#include "app/windows/opened_device.hpp"

#include "device/mouse/driver.hpp"
#include "device/registry.hpp"

#include <chrono>
#include <thread>

namespace touchtrial::app {

OpenedDevice::OpenedDevice(const std::string& driver, const device::DeviceSettings& settings,
                           Vec2 plane_mm) {
  if (driver == device::kMouseDriver) {
    window_ = std::make_unique<PointerWindow>(exchange_, plane_mm);
    device_ = std::make_unique<device::MouseDevice>(exchange_, clock_);
  } else {
    device_ = device::open_device(driver, settings);
  }
}

OpenedDevice::~OpenedDevice() = default;

void OpenedDevice::attend() {
  if (window_) {
    window_->draw_frame();
  } else {
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
}

bool OpenedDevice::stop_asked() const {
  return window_ && (window_->stop_asked() || window_->close_asked());
}

}  // namespace touchtrial::app

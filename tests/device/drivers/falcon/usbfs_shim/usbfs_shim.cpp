#include "device/drivers/falcon/usbfs_shim/usbfs_shim.hpp"

#include "device/drivers/falcon/usbfs_shim/usbfs_bus.hpp"

namespace touchtrial::testing {

ShimmedUsbDevice::ShimmedUsbDevice(UsbModel& model, const UsbIdentity& identity)
    : device_(std::make_shared<BusDevice>()) {
  device_->model = &model;
  device_->identity = identity;
  UsbfsBus::instance().add(device_);
}

ShimmedUsbDevice::~ShimmedUsbDevice() {
  unplug();
}

void ShimmedUsbDevice::unplug() {
  UsbfsBus::instance().remove(device_);
}

void ShimmedUsbDevice::plug() {
  // A new one, because handles of the old one never work again.
  auto next = std::make_shared<BusDevice>(*device_);
  ++next->identity.address;
  next->claimed_by = -1;
  device_ = std::move(next);
  UsbfsBus::instance().add(device_);
}

void ShimmedUsbDevice::set(bool BusDevice::*part, bool value) {
  UsbfsBus::instance().change([&] { (*device_).*part = value; });
}

bool ShimmedUsbDevice::has_kernel_driver() const {
  bool has = false;
  UsbfsBus::instance().change([&] { has = device_->kernel_driver; });
  return has;
}

bool ShimmedUsbDevice::is_claimed() const {
  bool is = false;
  UsbfsBus::instance().change([&] { is = device_->claimed_by >= 0; });
  return is;
}

int ShimmedUsbDevice::open_handles() const {
  return UsbfsBus::instance().handles_of(*device_);
}

void ShimmedUsbDevice::with_model(const std::function<void()>& action) {
  UsbfsBus::instance().change(action);
}

}  // namespace touchtrial::testing

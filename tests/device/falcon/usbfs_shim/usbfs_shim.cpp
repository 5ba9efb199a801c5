#include "device/falcon/usbfs_shim/usbfs_shim.hpp"

#include "device/falcon/usbfs_shim/usbfs_bus.hpp"

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

void ShimmedUsbDevice::allow(bool permitted) {
  UsbfsBus::instance().change([&] { device_->permitted = permitted; });
}

void ShimmedUsbDevice::use_elsewhere(bool used) {
  UsbfsBus::instance().change([&] { device_->used_elsewhere = used; });
}

void ShimmedUsbDevice::deafen(bool deaf) {
  UsbfsBus::instance().change([&] { device_->deaf = deaf; });
}

void ShimmedUsbDevice::stick_out(bool stuck) {
  UsbfsBus::instance().change([&] { device_->out_stuck = stuck; });
}

void ShimmedUsbDevice::halt_out() {
  UsbfsBus::instance().change([&] { device_->out_halted = true; });
}

void ShimmedUsbDevice::attach_kernel_driver(bool is_attached) {
  UsbfsBus::instance().change([&] { device_->kernel_driver = is_attached; });
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

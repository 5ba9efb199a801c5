/// \file A USB bus inside the test program, for the unmodified libusb-1.0. It answers open, close
/// and ioctl of /dev/bus/usb and /sys/bus/usb, and libudev's enumeration and monitor, because the
/// program's own functions of these names come before the libraries'.
///
/// A program that links touchtrial_usbfs_shim has to link libusb dynamically and export its symbols
/// (the library asks for both). Everything else that it opens goes to the system.
#pragma once

#include "device/drivers/falcon/usbfs_shim/usb_model.hpp"

#include <functional>
#include <memory>

namespace touchtrial::testing {

struct BusDevice {
  UsbModel* model = nullptr;
  UsbIdentity identity;
  bool permitted = true;
  bool used_elsewhere = false;
  bool kernel_driver = false;
  bool deaf = false;        ///< keeps completed transfers
  bool out_stuck = false;   ///< the bulk OUT endpoint answers NAK
  bool out_halted = false;  ///< ... or STALL, until it is cleared
  int claimed_by = -1;      ///< the handle's descriptor
};

/// A device that may be plugged into the bus. Any thread may use it.
class ShimmedUsbDevice {
 public:
  /// Plugs it in.
  /// \param model  must outlive this; called under the bus's lock only, by the thread that uses
  /// libusb
  explicit ShimmedUsbDevice(UsbModel& model, const UsbIdentity& identity = {});
  ~ShimmedUsbDevice();  ///< unplugs
  ShimmedUsbDevice(const ShimmedUsbDevice&) = delete;
  ShimmedUsbDevice& operator=(const ShimmedUsbDevice&) = delete;

  /// Unplugs it: open handles fail from now on, transfers under way end.
  void unplug();
  /// Plugs it in again, at the next address: the old one never works again, as on a real bus.
  void plug();

  void allow(bool permitted) { set(&BusDevice::permitted, permitted); }
  void use_elsewhere(bool used) { set(&BusDevice::used_elsewhere, used); }
  void attach_kernel_driver(bool is_attached) { set(&BusDevice::kernel_driver, is_attached); }
  void deafen(bool deaf) { set(&BusDevice::deaf, deaf); }
  void stick_out(bool stuck) { set(&BusDevice::out_stuck, stuck); }
  void halt_out() { set(&BusDevice::out_halted, true); }
  [[nodiscard]] bool has_kernel_driver() const;
  [[nodiscard]] bool is_claimed() const;
  [[nodiscard]] int open_handles() const;  ///< that libusb has not closed

  /// Changes the model while nothing else uses it, then lets waiting reads see it.
  void with_model(const std::function<void()>& action);

 private:
  void set(bool BusDevice::*part, bool value);

  std::shared_ptr<BusDevice> device_;
};

}  // namespace touchtrial::testing

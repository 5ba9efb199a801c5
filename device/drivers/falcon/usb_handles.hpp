/// \file RAII owners of libusb's objects, and the Falcons on the bus. Private to this folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <libusb.h>

namespace touchtrial::device::falcon {

struct UsbRelease {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
  void operator()(libusb_device* device) const noexcept { libusb_unref_device(device); }
  void operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }
  void operator()(libusb_transfer* transfer) const noexcept { libusb_free_transfer(transfer); }
};
using UsbContext = std::unique_ptr<libusb_context, UsbRelease>;
using UsbDevice = std::unique_ptr<libusb_device, UsbRelease>;
using UsbHandle = std::unique_ptr<libusb_device_handle, UsbRelease>;
using UsbTransfer = std::unique_ptr<libusb_transfer, UsbRelease>;

/// \throws DeviceError if libusb cannot start
[[nodiscard]] UsbContext make_usb_context();
/// \throws DeviceError if there is not enough memory
[[nodiscard]] UsbTransfer make_usb_transfer();

/// Claims the interface of a handle, and detaches a kernel driver for its lifetime.
class UsbClaim {
 public:
  /// \throws DeviceError naming `where` if another program uses it
  UsbClaim(libusb_device_handle* handle, const std::string& where);
  ~UsbClaim();
  UsbClaim(const UsbClaim&) = delete;
  UsbClaim& operator=(const UsbClaim&) = delete;

 private:
  libusb_device_handle* handle_;
};

/// \return the Falcons in the order of the bus
/// \throws DeviceError if the bus cannot be read
[[nodiscard]] std::vector<UsbDevice> falcons_on_bus(libusb_context* context);
/// \return for instance "USB bus 1 port 2, address 7"
[[nodiscard]] std::string usb_location_of(libusb_device* device);
/// \return the serial number; empty if the device does not report one
[[nodiscard]] std::string serial_of(libusb_device_handle* handle);
/// \throws DeviceError with the remedy if it may not be opened or was disconnected
[[nodiscard]] UsbHandle open_usb_device(libusb_device* device);

/// \return the cause and the remedy of an error of libusb, for the end of a message
[[nodiscard]] std::string usb_remedy(int error);

}  // namespace touchtrial::device::falcon

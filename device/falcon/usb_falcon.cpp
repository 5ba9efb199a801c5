#include "device/falcon/usb_falcon.hpp"

#include "core/errors.hpp"
#include "device/falcon/usb_ftdi.hpp"

#include <algorithm>

namespace touchtrial::device::falcon {
namespace {

/// Whether it can be claimed, told by doing so for a moment.
void fill_in(UsbFalcon& falcon, libusb_device* device) {
  try {
    const UsbHandle handle = open_usb_device(device);
    falcon.serial = serial_of(handle.get());
    if (libusb_kernel_driver_active(handle.get(), 0) != 1) {
      const UsbClaim claim(handle.get(), falcon.where);
    }
  } catch (const DeviceError& error) {
    falcon.trouble = error.what();
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + (word.empty() ? std::string("one without") : word);
  }
  return text;
}

/// The handle of the only one.
UsbHandle open_only(const std::vector<UsbDevice>& falcons) {
  if (falcons.size() == 1) return open_usb_device(falcons.front().get());
  std::vector<std::string> places;
  for (const UsbDevice& device : falcons) places.push_back(place_of(device.get()));
  throw DeviceError("falcon: there are several (" + joined(places) +
                    "); name the serial number of one in the device settings, falcon.serial");
}

/// The handle of the one with this serial number. Those that may not be opened are passed over,
/// unless none is left: then the reason of the last is told.
UsbHandle open_by_serial(const std::vector<UsbDevice>& falcons, const std::string& serial) {
  std::vector<std::string> seen;
  std::string trouble;
  for (const UsbDevice& device : falcons) {
    try {
      UsbHandle handle = open_usb_device(device.get());
      seen.push_back(serial_of(handle.get()));
      if (seen.back() == serial) return handle;
    } catch (const DeviceError& error) {
      trouble = error.what();
    }
  }
  if (!trouble.empty()) throw DeviceError(trouble);
  throw DeviceError(one_line("falcon: none has the serial number " + serial + ", but there is " +
                             joined(seen) + "; correct falcon.serial in the device settings"));
}

}  // namespace

std::vector<UsbFalcon> find_usb_falcons() {
  const UsbContext context = make_usb_context();
  std::vector<UsbFalcon> found;
  for (const UsbDevice& device : falcons_on_bus(context.get())) {
    found.push_back({place_of(device.get()), {}, {}});
    fill_in(found.back(), device.get());
  }
  return found;
}

std::unique_ptr<FtdiTransport> open_usb_falcon(const std::string& serial) {
  UsbContext context = make_usb_context();
  const std::vector<UsbDevice> falcons = falcons_on_bus(context.get());
  if (falcons.empty()) {
    throw DeviceError(
        "falcon: none is plugged in (USB 0403:cb48); plug it in and switch its power on");
  }
  UsbHandle handle = serial.empty() ? open_only(falcons) : open_by_serial(falcons, serial);
  return std::make_unique<UsbFtdi>(std::move(context), std::move(handle));
}

}  // namespace touchtrial::device::falcon

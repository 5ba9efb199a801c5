#include "device/drivers/falcon/usb_handles.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::device::falcon {
namespace {

constexpr std::uint16_t kVendor = 0x0403;
constexpr std::uint16_t kProduct = 0xcb48;
constexpr int kInterface = 0;

/// libusb's list of all devices, and the references that it holds.
class UsbList {
 public:
  explicit UsbList(libusb_context* context) : count_(libusb_get_device_list(context, &devices_)) {}
  ~UsbList() {
    if (count_ >= 0) libusb_free_device_list(devices_, 1);
  }
  UsbList(const UsbList&) = delete;
  UsbList& operator=(const UsbList&) = delete;

  [[nodiscard]] ssize_t count() const noexcept { return count_; }
  [[nodiscard]] libusb_device* at(ssize_t i) const noexcept { return devices_[i]; }

 private:
  libusb_device** devices_ = nullptr;
  ssize_t count_;
};

bool is_falcon_device(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  return libusb_get_device_descriptor(device, &descriptor) == 0 && descriptor.idVendor == kVendor &&
         descriptor.idProduct == kProduct;
}

}  // namespace

UsbContext make_usb_context() {
  libusb_context* context = nullptr;
  const int error = libusb_init(&context);
  if (error != 0) throw DeviceError("USB cannot be used: " + usb_remedy(error));
  return UsbContext(context);
}

UsbTransfer make_usb_transfer() {
  UsbTransfer transfer(libusb_alloc_transfer(0));
  if (!transfer) throw DeviceError("USB: no memory for a transfer; close other programs");
  return transfer;
}

UsbClaim::UsbClaim(libusb_device_handle* handle, const std::string& where) : handle_(handle) {
  libusb_set_auto_detach_kernel_driver(handle, 1);
  const int error = libusb_claim_interface(handle, kInterface);
  if (error != 0) throw DeviceError("falcon at " + where + ": " + usb_remedy(error));
}

UsbClaim::~UsbClaim() {
  libusb_release_interface(handle_, kInterface);
}

std::vector<UsbDevice> falcons_on_bus(libusb_context* context) {
  const UsbList list(context);
  if (list.count() < 0) {
    throw DeviceError("USB cannot be listed: " + usb_remedy(static_cast<int>(list.count())));
  }
  std::vector<UsbDevice> falcons;
  for (ssize_t i = 0; i < list.count(); ++i) {
    if (is_falcon_device(list.at(i))) falcons.emplace_back(libusb_ref_device(list.at(i)));
  }
  std::ranges::sort(falcons, {}, [](const UsbDevice& falcon) {
    return std::pair(libusb_get_bus_number(falcon.get()), libusb_get_device_address(falcon.get()));
  });
  return falcons;
}

std::string usb_location_of(libusb_device* device) {
  std::string location = "USB bus " + std::to_string(libusb_get_bus_number(device));
  std::array<std::uint8_t, 7> ports{};
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  for (int i = 0; i < depth; ++i) {
    location += (i == 0 ? " port " : ".") + std::to_string(ports[static_cast<std::size_t>(i)]);
  }
  return location + ", address " + std::to_string(libusb_get_device_address(device));
}

std::string serial_of(libusb_device_handle* handle) {
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(libusb_get_device(handle), &descriptor);
  if (descriptor.iSerialNumber == 0) return {};
  std::array<unsigned char, 128> text{};
  const int length = libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber,
                                                        text.data(), static_cast<int>(text.size()));
  return length > 0 ? one_line(std::string(text.begin(), text.begin() + length)) : std::string();
}

UsbHandle open_usb_device(libusb_device* device) {
  libusb_device_handle* handle = nullptr;
  const int error = libusb_open(device, &handle);
  if (error != 0)
    throw DeviceError("falcon at " + usb_location_of(device) + ": " + usb_remedy(error));
  return UsbHandle(handle);
}

std::string usb_remedy(int error) {
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      return "no permission to use it; run scripts/install-udev-rules as root, then unplug it and "
             "plug it in again";
    case LIBUSB_ERROR_BUSY:
      return "another program uses it; close that program";
    case LIBUSB_ERROR_NO_DEVICE:
      return "it was unplugged; plug it in and switch its power on";
    default:
      return std::string(libusb_error_name(error)) +
             "; unplug it, plug it in again, and see the kernel's messages (dmesg)";
  }
}

}  // namespace touchtrial::device::falcon

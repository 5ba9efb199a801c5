#include "device/drivers/falcon/usbfs_shim/usb_model.hpp"

#include <algorithm>
#include <cstdio>

namespace touchtrial::testing {
namespace {

constexpr std::size_t kSetupBytes = 8;
constexpr std::uint8_t kGetDescriptor = 6;
constexpr std::uint8_t kStringDescriptor = 3;
constexpr std::uint8_t kSerialIndex = 3;

std::uint8_t low(std::uint16_t value) {
  return static_cast<std::uint8_t>(value & 0xffU);
}
std::uint8_t high(std::uint16_t value) {
  return static_cast<std::uint8_t>(value >> 8U);
}

std::vector<std::uint8_t> string_descriptor(const UsbIdentity& identity, std::uint8_t index) {
  if (index == 0) return {4, kStringDescriptor, 0x09, 0x04};
  std::vector<std::uint8_t> bytes = {0, kStringDescriptor};
  for (const char letter : index == kSerialIndex ? identity.serial : std::string("FALCON HAPTIC")) {
    bytes.push_back(static_cast<std::uint8_t>(letter));
    bytes.push_back(0);
  }
  bytes[0] = static_cast<std::uint8_t>(bytes.size());
  return bytes;
}

}  // namespace

std::string UsbIdentity::node() const {
  char path[40];
  std::snprintf(path, sizeof(path), "/dev/bus/usb/%03d/%03d", bus, address);
  return path;
}

std::vector<std::uint8_t> usb_descriptors(const UsbIdentity& identity) {
  const std::uint8_t serial = identity.serial.empty() ? std::uint8_t{0} : kSerialIndex;
  return {18, 1, 0x00, 0x02, 0, 0, 0, 64, low(identity.vendor), high(identity.vendor),
          low(identity.product), high(identity.product), 0x00, 0x04, 1, 2, serial, 1,
          // Configuration, interface, bulk IN 0x81, bulk OUT 0x02.
          9, 2, 32, 0, 1, 1, 0, 0x80, 50,      //
          9, 4, 0, 0, 2, 0xff, 0xff, 0xff, 2,  //
          7, 5, 0x81, 2, 64, 0, 0,             //
          7, 5, 0x02, 2, 64, 0, 0};
}

std::optional<std::size_t> answer_control(const UsbIdentity& identity, UsbModel& model,
                                          std::span<std::uint8_t> setup) {
  if (setup.size() < kSetupBytes) return std::nullopt;
  const auto value = static_cast<std::uint16_t>(setup[2] | setup[3] << 8);
  if (setup[0] == 0x40) {
    const auto index = static_cast<std::uint16_t>(setup[4] | setup[5] << 8);
    return model.vendor_request(setup[1], value, index) ? std::optional<std::size_t>(0)
                                                        : std::nullopt;
  }
  if (setup[0] != 0x80 || setup[1] != kGetDescriptor || setup[3] != kStringDescriptor) {
    return std::nullopt;
  }
  const auto text = string_descriptor(identity, setup[2]);
  const std::size_t wanted = setup[6] | static_cast<std::size_t>(setup[7]) << 8U;
  const std::size_t length = std::min({wanted, text.size(), setup.size() - kSetupBytes});
  std::copy_n(text.begin(), length, setup.begin() + kSetupBytes);
  return length;
}

bool EmulatorUsbModel::vendor_request(std::uint8_t request, std::uint16_t value,
                                      std::uint16_t index) {
  return emulator_.control({0x40, request, value, index}) == device::falcon::UsbStatus::ok;
}

void EmulatorUsbModel::bulk_out(std::span<const std::uint8_t> bytes) {
  // The emulator stays plugged in.
  static_cast<void>(emulator_.bulk_out(bytes));
}

std::size_t EmulatorUsbModel::bulk_in(std::span<std::uint8_t> bytes) {
  if (emulator_.waiting() == 0) return 0;
  std::vector<std::uint8_t> transfer;
  static_cast<void>(emulator_.bulk_in(bytes.size(), transfer));
  std::ranges::copy(transfer, bytes.begin());
  return transfer.size();
}

}  // namespace touchtrial::testing

#include "device/falcon/usbfs_shim/emulator_usb_model.hpp"

#include <algorithm>

namespace touchtrial::testing {

bool EmulatorUsbModel::vendor_request(std::uint8_t request, std::uint16_t value,
                                      std::uint16_t index) {
  return emulator_.control({0x40, request, value, index}) == device::falcon::UsbStatus::ok;
}

void EmulatorUsbModel::bulk_out(std::span<const std::uint8_t> bytes) {
  // It stays plugged in, see above.
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

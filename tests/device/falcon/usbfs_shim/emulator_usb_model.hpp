/// \file The emulated Falcon as a device on a stand-in USB bus.
#pragma once

#include "device/falcon/emulator/falcon_emulator.hpp"
#include "device/falcon/usbfs_shim/usb_model.hpp"

namespace touchtrial::testing {

/// Threads as the emulator. Unplugging is the bus's: the emulator stays plugged in, but what it
/// does on losing its cable is the caller's to ask for.
class EmulatorUsbModel final : public UsbModel {
 public:
  /// \param emulator  must outlive this
  explicit EmulatorUsbModel(device::falcon::FalconEmulator& emulator) : emulator_(emulator) {}

  [[nodiscard]] bool vendor_request(std::uint8_t request, std::uint16_t value,
                                    std::uint16_t index) override;
  void bulk_out(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::size_t bulk_in(std::span<std::uint8_t> bytes) override;

 private:
  device::falcon::FalconEmulator& emulator_;
};

}  // namespace touchtrial::testing

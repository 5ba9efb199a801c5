/// \file A stand-in for a USB device, and the emulated Falcon as one. The usbfs shim or umockdev
/// brings it the transfers.
#pragma once

#include "device/drivers/falcon/emulator/falcon_emulator.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::testing {

/// A device with vendor requests and one bulk endpoint each way, like the FTDI chip.
class UsbModel {
 public:
  virtual ~UsbModel() = default;
  /// \return false for a stall
  [[nodiscard]] virtual bool vendor_request(std::uint8_t request, std::uint16_t value,
                                            std::uint16_t index) = 0;
  virtual void bulk_out(std::span<const std::uint8_t> bytes) = 0;
  /// \return how many bytes came into `bytes`; 0 if there are none yet
  [[nodiscard]] virtual std::size_t bulk_in(std::span<std::uint8_t> bytes) = 0;
};

/// How a device presents itself on the bus.
struct UsbIdentity {
  int bus = 1;
  int address = 7;
  std::string port = "1-2";  ///< as in /sys/bus/usb/devices
  std::string serial = "FALCON1";
  std::uint16_t vendor = 0x0403;
  std::uint16_t product = 0xcb48;

  [[nodiscard]] std::string node() const;  ///< /dev/bus/usb/001/007
};

/// Device descriptor and configuration, as the kernel shows them in sysfs.
[[nodiscard]] std::vector<std::uint8_t> usb_descriptors(const UsbIdentity& identity);

/// Answers a control transfer.
/// \param setup  8 bytes of set-up, then room for data
/// \return how many bytes of data it wrote after the set-up; nothing: the device stalls
[[nodiscard]] std::optional<std::size_t> answer_control(const UsbIdentity& identity,
                                                        UsbModel& model,
                                                        std::span<std::uint8_t> setup);

/// The emulated Falcon as a device on a stand-in bus. Threads as the emulator. The bus unplugs it;
/// the emulator stays plugged in, and the caller tells it to lose its cable.
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

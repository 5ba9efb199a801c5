/// \file The FTDI chip of a Falcon, by libusb. Private to this folder.
#pragma once

#include "device/falcon/ftdi_transport.hpp"
#include "device/falcon/usb_handles.hpp"

#include <string>

namespace touchtrial::device::falcon {

class UsbFtdi final : public FtdiTransport {
 public:
  /// Takes over an open device and claims it.
  /// \throws DeviceError if another program has it
  UsbFtdi(UsbContext context, UsbHandle handle);
  ~UsbFtdi() override;

  [[nodiscard]] std::string serial() const override { return serial_; }
  void control(FtdiRequest request, std::uint16_t value) override;
  [[nodiscard]] std::size_t send(std::span<const std::uint8_t> bytes,
                                 std::chrono::milliseconds limit) override;
  [[nodiscard]] std::size_t receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                    std::chrono::milliseconds limit) override;

  void start_stream(FtdiStreamSink& sink) override;
  void stop_stream() noexcept override;
  [[nodiscard]] bool post(std::span<const std::uint8_t> bytes) noexcept override;
  void serve(std::chrono::microseconds at_most) noexcept override;
  [[nodiscard]] bool lost() const noexcept override { return lost_; }

 private:
  static void LIBUSB_CALL on_read(libusb_transfer* transfer);
  static void LIBUSB_CALL on_sent(libusb_transfer* transfer);
  [[nodiscard]] std::size_t transfer(unsigned char endpoint, std::uint8_t* bytes, int count,
                                     std::chrono::milliseconds limit);
  void queue_read() noexcept;
  /// Counts failures in a row; too many, or an unplugged device, and it is lost.
  void note(libusb_transfer_status status) noexcept;

  // In the order in which they are needed, hence released in the reverse.
  UsbContext context_;
  UsbHandle handle_;
  std::string where_;
  std::string serial_;
  UsbClaim claim_;
  UsbTransfer read_;
  UsbTransfer send_;
  std::array<std::uint8_t, kUsbPacketSize> in_{};
  std::array<std::uint8_t, kUsbPacketSize> out_{};
  FtdiStreamSink* sink_ = nullptr;  ///< null: no stream, reads are not queued again
  bool reading_ = false;
  bool sending_ = false;
  int failures_ = 0;
  int deaf_ = 0;  ///< times in a row that libusb could not tell what happened
  bool lost_ = false;
};

}  // namespace touchtrial::device::falcon

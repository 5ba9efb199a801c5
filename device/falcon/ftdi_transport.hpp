/// \file What the Falcon driver asks of the FTDI chip in the device, without saying how it gets
/// there: libusb in the product (usb_falcon.hpp), an emulator in the tests.
#pragma once

#include "device/falcon/falcon_packet.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace touchtrial::device::falcon {

/// The chip's vendor requests (request type 0x40, index 0) that the driver uses.
enum class FtdiRequest : std::uint8_t {
  purge = 0,
  modem_control = 1,
  flow_control = 2,
  baud_divisor = 3,
  data_format = 4,
  latency_timer = 9,
};

/// Who receives the bytes of the stream. Called on the thread that calls FtdiTransport::serve.
class FtdiStreamSink {
 public:
  virtual ~FtdiStreamSink() = default;
  /// \param transfer  what one bulk transfer brought, with the chip's status bytes; may be empty
  virtual void receive(std::span<const std::uint8_t> transfer) noexcept = 0;
};

/// A chip that is open and claimed; closed by the destructor. Belongs to one thread at a time. It
/// is used in two ways that are never mixed: one transfer after the other, which waits and throws,
/// for setting up; and the stream, with one read always queued, which neither waits nor throws.
class FtdiTransport {
 public:
  virtual ~FtdiTransport() = default;

  /// Empty if the device has none.
  [[nodiscard]] virtual std::string serial() const = 0;

  /// \name Setting up: each waits, and throws DeviceError if the device is gone
  ///@{
  virtual void control(FtdiRequest request, std::uint16_t value) = 0;
  /// \return how many bytes went out in this time; fewer than all if it was too short
  [[nodiscard]] virtual std::size_t send(std::span<const std::uint8_t> bytes,
                                         std::chrono::milliseconds limit) = 0;
  /// The next packet, status bytes and all.
  /// \return its length; 0 if none came in this time
  [[nodiscard]] virtual std::size_t receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                            std::chrono::milliseconds limit) = 0;
  ///@}

  /// \name Stream
  ///@{
  /// Queues the first read. \throws DeviceError if it cannot
  /// \param sink  must outlive the stream
  virtual void start_stream(FtdiStreamSink& sink) = 0;
  /// Ends the stream and waits until nothing is under way, for some seconds at most: if there still
  /// is something then, the device counts as lost. Safe on a lost device.
  virtual void stop_stream() noexcept = 0;
  /// Sends without waiting. \return whether it was taken: the one before may still be under way
  [[nodiscard]] virtual bool post(std::span<const std::uint8_t> bytes) noexcept = 0;
  /// Waits until something arrives, at most this long, and hands on all that has.
  virtual void serve(std::chrono::microseconds at_most) noexcept = 0;
  /// Unplugged, or broken beyond use. Never mends: open the device anew.
  [[nodiscard]] virtual bool lost() const noexcept = 0;
  ///@}
};

}  // namespace touchtrial::device::falcon

/// \file The Falcon driver's interface to the device's FTDI chip, implemented by libusb
/// (usb_falcon.hpp) and by an emulator in the tests.
#pragma once

#include "device/drivers/falcon/falcon_packet.hpp"

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

/// Receives the bytes of the stream, on the thread that calls FtdiTransport::serve.
class FtdiStreamSink {
 public:
  virtual ~FtdiStreamSink() = default;
  /// \param transfer  one bulk transfer, including the chip's status bytes; may be empty
  virtual void receive(std::span<const std::uint8_t> transfer) noexcept = 0;
  /// Called when a posted packet was sent.
  virtual void sent() noexcept {}
};

/// An open, claimed chip; the destructor closes it. Belongs to one thread at a time. It has two
/// separate modes: single transfers for setup, which block and throw; and a stream with one read
/// always queued, which neither blocks nor throws.
class FtdiTransport {
 public:
  virtual ~FtdiTransport() = default;

  /// \return the serial number; empty if the device has none
  [[nodiscard]] virtual std::string serial() const = 0;

  /// \name Setup: all block, and throw DeviceError if the device was disconnected
  ///@{
  virtual void control(FtdiRequest request, std::uint16_t value) = 0;
  /// \return the number of sent bytes, fewer than all at the time limit
  /// \throws DeviceError at once if the bus did not return an earlier transfer
  [[nodiscard]] virtual std::size_t send(std::span<const std::uint8_t> bytes,
                                         std::chrono::milliseconds limit) = 0;
  /// Receives the next packet, including its status bytes.
  /// \return its length; 0 at the time limit
  [[nodiscard]] virtual std::size_t receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                            std::chrono::milliseconds limit) = 0;
  ///@}

  /// \name Stream
  ///@{
  /// Queues the first read.
  /// \param sink  must outlive the stream
  /// \throws DeviceError if the read cannot be queued
  virtual void start_stream(FtdiStreamSink& sink) = 0;
  /// Ends the stream and waits at most a few seconds for pending transfers; if one remains, the
  /// device counts as lost. Safe on a lost device.
  virtual void stop_stream() noexcept = 0;
  /// Sends at most kUsbPacketSize bytes without waiting. If the device has not yet accepted the
  /// previous packet, that packet is cancelled and replaced, so that an old force does not delay a
  /// new one. After kMaxStuck such packets in a row the link is lost.
  /// \return whether the bytes were accepted
  [[nodiscard]] virtual bool post(std::span<const std::uint8_t> bytes) noexcept = 0;
  static constexpr int kMaxStuck = 5;
  /// Waits at most this long for bytes and passes them to the sink.
  virtual void serve(std::chrono::microseconds max_wait) noexcept = 0;
  /// \return whether the device is unplugged or unusable. Permanent: reopen the device.
  [[nodiscard]] virtual bool lost() const noexcept = 0;
  ///@}
};

}  // namespace touchtrial::device::falcon

#include "device/falcon/rig/emulator_transport.hpp"

#include "core/errors.hpp"

#include <algorithm>

namespace touchtrial::device::falcon {
namespace {

void throw_if_gone(UsbStatus status) {
  if (status != UsbStatus::ok) throw DeviceError("emulated falcon: unplugged");
}

}  // namespace

void EmulatorTransport::control(FtdiRequest request, std::uint16_t value) {
  throw_if_gone(emulator_.control({0x40, static_cast<std::uint8_t>(request), value, 0}));
}

std::size_t EmulatorTransport::send(std::span<const std::uint8_t> bytes,
                                    std::chrono::milliseconds /*limit*/) {
  throw_if_gone(emulator_.bulk_out(bytes));
  return bytes.size();
}

std::size_t EmulatorTransport::receive(std::span<std::uint8_t, kUsbPacketSize> packet,
                                       std::chrono::milliseconds /*limit*/) {
  std::vector<std::uint8_t> bytes;
  throw_if_gone(emulator_.bulk_in(packet.size(), bytes));
  std::ranges::copy(bytes, packet.begin());
  return bytes.size();
}

void EmulatorTransport::start_stream(FtdiStreamSink& sink) {
  if (lost()) throw_if_gone(UsbStatus::gone);
  sink_ = &sink;
}

bool EmulatorTransport::post(std::span<const std::uint8_t> bytes) noexcept {
  return emulator_.bulk_out(bytes) == UsbStatus::ok;
}

void EmulatorTransport::serve(std::chrono::microseconds /*at_most*/) noexcept {
  std::vector<std::uint8_t> bytes;
  if (sink_ != nullptr && emulator_.bulk_in(kUsbPacketSize, bytes) == UsbStatus::ok) {
    sink_->receive(bytes);
  }
}

}  // namespace touchtrial::device::falcon

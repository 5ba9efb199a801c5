#include "device/drivers/falcon/falcon_packet.hpp"

#include <algorithm>

namespace touchtrial::device::falcon {
namespace {

constexpr std::uint8_t kFirst = '<';
constexpr std::uint8_t kLast = '>';
constexpr std::uint8_t kZero = 0x41;
constexpr std::size_t kFlagsAt = 13;
constexpr std::size_t kUnusedAt = 14;
constexpr std::size_t kLastAt = kPacketSize - 1;
constexpr std::size_t kNibbles = 4;

void put_nibbles(Packet& packet, std::size_t axis, std::int16_t value) noexcept {
  const auto bits = static_cast<std::uint16_t>(value);
  for (std::size_t i = 0; i < kNibbles; ++i) {
    packet[1 + kNibbles * axis + i] =
        static_cast<std::uint8_t>(kZero + ((bits >> (4U * i)) & 0xFU));
  }
}

std::int16_t take_nibbles(std::span<const std::uint8_t, kPacketSize> packet,
                          std::size_t axis) noexcept {
  unsigned bits = 0;
  for (std::size_t i = 0; i < kNibbles; ++i) {
    bits |= (packet[1 + kNibbles * axis + i] - unsigned{kZero}) << (4U * i);
  }
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

/// \return whether a byte is valid at this position of a reply
bool fits_reply(std::uint8_t byte, std::size_t at) noexcept {
  if (at == 0) return byte == kFirst;
  if (at < kFlagsAt) return byte >= kZero && byte <= kZero + 0xF;
  if (at == kFlagsAt) return byte >= kZero;
  if (at == kUnusedAt) return byte != kFirst && byte != kLast;
  return byte == kLast;
}

}  // namespace

std::uint8_t led_bits(const Lights& lights, const std::array<int, 3>& order) noexcept {
  const std::array<bool, 3> on = {lights.red, lights.green, lights.blue};
  unsigned bits = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (on[i] && order[i] >= 0 && order[i] <= 2) bits |= 1U << static_cast<unsigned>(order[i]);
  }
  return static_cast<std::uint8_t>(bits);
}

Packet encode_command(const Command& command) noexcept {
  Packet packet;
  packet.fill(kZero);
  packet[0] = kFirst;
  for (std::size_t axis = 0; axis < 3; ++axis) put_nibbles(packet, axis, command.motors[axis]);
  const unsigned flags = (command.homing ? 1U : 0U) | (command.leds & 7U) << 1U;
  packet[kFlagsAt] = static_cast<std::uint8_t>(kZero + flags);
  packet[kLastAt] = kLast;
  return packet;
}

std::optional<Reply> decode_reply(std::span<const std::uint8_t, kPacketSize> packet) noexcept {
  for (std::size_t at = 0; at < kPacketSize; ++at) {
    if (!fits_reply(packet[at], at)) return std::nullopt;
  }
  Reply reply;
  for (std::size_t axis = 0; axis < 3; ++axis) reply.counts[axis] = take_nibbles(packet, axis);
  const unsigned flags = packet[kFlagsAt] - unsigned{kZero};
  reply.buttons = flags & 0xFU;
  for (std::size_t axis = 0; axis < 3; ++axis) reply.homed[axis] = (flags >> (4 + axis) & 1U) != 0;
  return reply;
}

int FalconStream::push_transfer(std::span<const std::uint8_t> transfer) noexcept {
  int finished = 0;
  while (!transfer.empty()) {
    const auto usb_packet = transfer.first(std::min(transfer.size(), kUsbPacketSize));
    for (std::size_t i = kFtdiStatusSize; i < usb_packet.size(); ++i) {
      if (push_byte(usb_packet[i])) ++finished;
    }
    transfer = transfer.subspan(usb_packet.size());
  }
  return finished;
}

void FalconStream::restart() noexcept {
  discarded_ += size_;
  size_ = 0;
}

void FalconStream::start_packet_at(std::uint8_t byte) noexcept {
  restart();
  if (byte == kFirst) {
    packet_[size_++] = byte;
  } else {
    ++discarded_;
  }
}

bool FalconStream::push_byte(std::uint8_t byte) noexcept {
  // Only a packet's first byte can start a packet, so no byte has to be read twice.
  if (!fits_reply(byte, size_)) {
    start_packet_at(byte);
    return false;
  }
  packet_[size_++] = byte;
  if (size_ < kPacketSize) return false;
  size_ = 0;
  newest_ = decode_reply(packet_).value_or(newest_);
  ++replies_;
  return true;
}

}  // namespace touchtrial::device::falcon

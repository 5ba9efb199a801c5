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

void write_nibbles(Packet& packet, std::size_t axis, std::int16_t value) noexcept {
  const auto bits = static_cast<std::uint16_t>(value);
  for (std::size_t i = 0; i < kNibbles; ++i) {
    packet[1 + kNibbles * axis + i] =
        static_cast<std::uint8_t>(kZero + ((bits >> (4U * i)) & 0xFU));
  }
}

std::int16_t read_nibbles(std::span<const std::uint8_t, kPacketSize> packet,
                          std::size_t axis) noexcept {
  unsigned bits = 0;
  for (std::size_t i = 0; i < kNibbles; ++i) {
    bits |= (packet[1 + kNibbles * axis + i] - unsigned{kZero}) << (4U * i);
  }
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
}

/// \return whether a byte is valid at this position of a reply
bool is_valid_in_reply(std::uint8_t byte, std::size_t position) noexcept {
  if (position == 0) return byte == kFirst;
  if (position < kFlagsAt) return byte >= kZero && byte <= kZero + 0xF;
  if (position == kFlagsAt) return byte >= kZero;
  if (position == kUnusedAt) return byte != kFirst && byte != kLast;
  return byte == kLast;
}

}  // namespace

std::uint8_t led_bits(const Lights& lights, const std::array<int, 3>& order) noexcept {
  const std::array<bool, 3> is_on = {lights.red, lights.green, lights.blue};
  unsigned bits = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_on[i] && order[i] >= 0 && order[i] <= 2) bits |= 1U << static_cast<unsigned>(order[i]);
  }
  return static_cast<std::uint8_t>(bits);
}

Packet encode_command(const Command& command) noexcept {
  Packet packet;
  packet.fill(kZero);
  packet[0] = kFirst;
  for (std::size_t axis = 0; axis < 3; ++axis) write_nibbles(packet, axis, command.motors[axis]);
  const unsigned flags = (command.homing ? 1U : 0U) | (command.leds & 7U) << 1U;
  packet[kFlagsAt] = static_cast<std::uint8_t>(kZero + flags);
  packet[kLastAt] = kLast;
  return packet;
}

std::optional<Reply> decode_reply(std::span<const std::uint8_t, kPacketSize> packet) noexcept {
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    if (!is_valid_in_reply(packet[i], i)) return std::nullopt;
  }
  Reply reply;
  for (std::size_t axis = 0; axis < 3; ++axis) reply.counts[axis] = read_nibbles(packet, axis);
  const unsigned flags = packet[kFlagsAt] - unsigned{kZero};
  reply.buttons = flags & 0xFU;
  for (std::size_t axis = 0; axis < 3; ++axis) reply.homed[axis] = (flags >> (4 + axis) & 1U) != 0;
  return reply;
}

int FalconStream::push_transfer(std::span<const std::uint8_t> transfer) noexcept {
  int completed = 0;
  while (!transfer.empty()) {
    const auto usb_packet = transfer.first(std::min(transfer.size(), kUsbPacketSize));
    for (std::size_t i = kFtdiStatusSize; i < usb_packet.size(); ++i) {
      if (push_byte(usb_packet[i])) ++completed;
    }
    transfer = transfer.subspan(usb_packet.size());
  }
  return completed;
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
  // Only '<' can start a packet, and it occurs nowhere else, so no discarded byte starts a packet.
  if (!is_valid_in_reply(byte, size_)) {
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

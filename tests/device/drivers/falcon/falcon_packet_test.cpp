#include "device/drivers/falcon/falcon_packet.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device::falcon {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// \return a reply as the device writes it, built by hand
Packet packet_of(const EncoderCounts& counts, unsigned flags) {
  Packet packet;
  packet.fill('A');
  packet[0] = '<';
  for (std::size_t axis = 0; axis < 3; ++axis) {
    unsigned bits = static_cast<std::uint16_t>(counts[axis]);
    for (std::size_t i = 0; i < 4; ++i, bits /= 16) {
      packet[1 + 4 * axis + i] = static_cast<std::uint8_t>('A' + bits % 16);
    }
  }
  packet[13] = static_cast<std::uint8_t>('A' + flags);
  packet[15] = '>';
  return packet;
}

/// \return the bytes as one bulk transfer, in USB packets with status bytes
Bytes transfer_of(std::span<const std::uint8_t> payload) {
  Bytes transfer;
  do {
    const auto part = payload.first(std::min<std::size_t>(payload.size(), 62));
    transfer.insert(transfer.end(), {0x01, 0x60});
    transfer.insert(transfer.end(), part.begin(), part.end());
    payload = payload.subspan(part.size());
  } while (!payload.empty());
  return transfer;
}

Bytes bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Bytes reply_bytes(const EncoderCounts& counts, unsigned flags = 0x70) {
  const Packet packet = packet_of(counts, flags);
  return {packet.begin(), packet.end()};
}

std::string text_of_packet(const Packet& packet) {
  return {packet.begin(), packet.end()};
}

TEST_CASE("falcon packets: a command is written nibble by nibble, the least significant first") {
  CHECK(text_of_packet(encode_command({})) == "<AAAAAAAAAAAABA>");
  CHECK(text_of_packet(encode_command({{0x1234, -1, -32768}, 0, true})) == "<EDCBPPPPAAAIBA>");
  CHECK(text_of_packet(encode_command({{1, 0, 0}, 7, true})) == "<BAAAAAAAAAAAPA>");
  CHECK(text_of_packet(encode_command({{0, 0, 0}, 1, false})) == "<AAAAAAAAAAAACA>");
  CHECK(text_of_packet(encode_command({{0, 0, 0}, 0xF8, false})) == "<AAAAAAAAAAAAAA>");
}

TEST_CASE("falcon packets: every count of every axis is read as it was written") {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int count = -32768; count <= 32767; ++count) {
      EncoderCounts counts = {7, -7, 77};
      counts[axis] = static_cast<std::int16_t>(count);
      const auto reply = decode_reply(packet_of(counts, 0));
      if (!reply || reply->counts != counts) FAIL("axis " << axis << ", count " << count);
    }
  }
}

TEST_CASE("falcon packets: motor values are written as counts are read") {
  RandomStream random(1, "falcon motors");
  for (int i = 0; i < 10000; ++i) {
    MotorValues values{};
    for (auto& value : values) value = static_cast<std::int16_t>(random.bits());
    REQUIRE(decode_reply(encode_command({values, 0, true}))->counts == values);
  }
}

TEST_CASE("falcon packets: flags are four buttons and three homed axes") {
  for (unsigned flags = 0; flags < 128; ++flags) {
    const auto reply = decode_reply(packet_of({}, flags));
    REQUIRE(reply);
    REQUIRE(reply->buttons == (flags & 15U));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      REQUIRE(reply->homed[axis] == ((flags & (16U << axis)) != 0));
    }
    REQUIRE(reply->all_homed() == (flags >= 112));
  }
  CHECK(decode_reply(packet_of({}, 1))->buttons == kButtonPlus);
  CHECK(decode_reply(packet_of({}, 2))->buttons == kButtonForward);
  CHECK(decode_reply(packet_of({}, 4))->buttons == kButtonCentre);
  CHECK(decode_reply(packet_of({}, 8))->buttons == kButtonMinus);
}

/// \return whether a byte is valid at a place of a reply, by the table of the protocol
bool may_stand(unsigned byte, std::size_t at) {
  if (at == 0) return byte == '<';
  if (at == 15) return byte == '>';
  if (at == 14) return byte != '<' && byte != '>';
  return at == 13 ? byte >= 'A' : byte >= 'A' && byte <= 'P';
}

TEST_CASE("falcon packets: one wrong byte anywhere makes it no reply") {
  for (std::size_t at = 0; at < kPacketSize; ++at) {
    for (unsigned byte = 0; byte < 256; ++byte) {
      Packet packet = packet_of({1, 2, 3}, 0x70);
      packet[at] = static_cast<std::uint8_t>(byte);
      INFO("byte " << byte << " at " << at);
      REQUIRE(decode_reply(packet).has_value() == may_stand(byte, at));
    }
  }
}

TEST_CASE("falcon lights: the order of the colours is the user's") {
  CHECK(led_bits({true, false, false}, {0, 1, 2}) == 1);
  CHECK(led_bits({false, true, false}, {0, 1, 2}) == 2);
  CHECK(led_bits({false, false, true}, {0, 1, 2}) == 4);
  CHECK(led_bits({true, false, false}, {2, 0, 1}) == 4);
  CHECK(led_bits({true, true, true}, {2, 0, 1}) == 7);
  CHECK(led_bits({}, {0, 1, 2}) == 0);
  CHECK(led_bits({true, true, true}, {-1, 3, 99}) == 0);
}

TEST_CASE("falcon stream: status bytes alone, or half of them, give no reply") {
  FalconStream stream;
  CHECK(stream.push_transfer({}) == 0);
  CHECK(stream.push_transfer(Bytes{0x01}) == 0);
  CHECK(stream.push_transfer(Bytes{0x01, 0x60}) == 0);
  CHECK(stream.push_transfer(Bytes{'<', '>'}) == 0);
  CHECK(stream.replies() == 0);
  CHECK(stream.discarded_bytes() == 0);
}

TEST_CASE("falcon stream: a reply in two transfers, split anywhere") {
  for (std::size_t cut = 0; cut <= kPacketSize; ++cut) {
    FalconStream stream;
    const Bytes reply = reply_bytes({5, 6, 7});
    const std::span<const std::uint8_t> bytes = reply;
    const int first = stream.push_transfer(transfer_of(bytes.first(cut)));
    CHECK(first == (cut == kPacketSize ? 1 : 0));
    CHECK(first + stream.push_transfer(transfer_of(bytes.subspan(cut))) == 1);
    CHECK(stream.newest().counts == EncoderCounts{5, 6, 7});
  }
}

TEST_CASE("falcon stream: an incomplete packet before a whole one is discarded") {
  for (std::size_t kept = 0; kept < kPacketSize; ++kept) {
    FalconStream stream;
    Bytes torn = reply_bytes({1, 1, 1});
    torn.resize(kept);
    CHECK(stream.push_transfer(transfer_of(joined({torn, reply_bytes({9, 9, 9})}))) == 1);
    CHECK(stream.newest().counts == EncoderCounts{9, 9, 9});
    CHECK(stream.discarded_bytes() == kept);
  }
}

TEST_CASE("falcon stream: garbage before, between and after replies is counted and ignored") {
  FalconStream stream;
  const Bytes payload = joined({bytes_of("noise>>A<<"),
                                reply_bytes({1, 0, 0}),
                                bytes_of("<AAA>"),
                                reply_bytes({2, 0, 0}),
                                bytes_of("<AAAAAAAAAAAAAAAAAAAAAAAA"),
                                {0x00, 0xFF}});
  CHECK(stream.push_transfer(transfer_of(payload)) == 2);
  CHECK(stream.newest().counts[0] == 2);
  CHECK(stream.push_transfer(transfer_of(reply_bytes({3, 0, 0}))) == 1);
  CHECK(stream.discarded_bytes() == payload.size() - 2 * kPacketSize);
}

TEST_CASE("falcon stream: after a purge the unfinished packet is forgotten") {
  FalconStream stream;
  const Bytes reply = reply_bytes({4, 4, 4});
  const std::span<const std::uint8_t> bytes = reply;
  CHECK(stream.push_transfer(transfer_of(bytes.first(10))) == 0);
  stream.restart();
  CHECK(stream.discarded_bytes() == 10);
  CHECK(stream.push_transfer(transfer_of(bytes.subspan(10))) == 0);
  CHECK(stream.discarded_bytes() == 16);
}

/// \return the replies in a payload, by a search at every place
std::vector<EncoderCounts> replies_in(const Bytes& payload) {
  std::vector<EncoderCounts> found;
  for (std::size_t at = 0; at + kPacketSize <= payload.size(); ++at) {
    const auto reply =
        decode_reply(std::span<const std::uint8_t, kPacketSize>(&payload[at], kPacketSize));
    if (reply) found.push_back(reply->counts);
  }
  return found;
}

Bytes damaged(Bytes bytes, RandomStream& random) {
  const auto at = static_cast<std::ptrdiff_t>(random.below(bytes.size()));
  switch (random.below(5)) {
    case 0:
      bytes.erase(bytes.begin() + at);
      break;
    case 1:
      bytes.insert(bytes.begin() + at, '<');
      break;
    case 2:
      bytes.resize(static_cast<std::size_t>(at));
      break;
    case 3:
      bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(random.bits());
      break;
    default:
      break;
  }
  return bytes;
}

TEST_CASE("falcon stream finds the same packets in random damage as a search at every place") {
  RandomStream random(3, "falcon stream");
  for (int round = 0; round < 2000; ++round) {
    Bytes payload;
    for (int i = 0; i < 8; ++i) {
      const auto count = static_cast<std::int16_t>(random.bits());
      payload = joined({payload, damaged(reply_bytes({count, count, 1}), random)});
    }
    const std::vector<EncoderCounts> expected = replies_in(payload);
    FalconStream stream;
    int found = 0;
    std::span<const std::uint8_t> rest = payload;
    while (!rest.empty()) {
      const auto part = rest.first(std::min<std::size_t>(rest.size(), 1 + random.below(130)));
      found += stream.push_transfer(transfer_of(part));
      rest = rest.subspan(part.size());
    }
    REQUIRE(found == static_cast<int>(expected.size()));
    if (!expected.empty()) REQUIRE(stream.newest().counts == expected.back());
  }
}

}  // namespace
}  // namespace touchtrial::device::falcon

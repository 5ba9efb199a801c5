#include "device/drivers/falcon/falcon_firmware.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>

namespace touchtrial::device::falcon {
namespace {

using std::chrono::milliseconds;
using Bytes = std::vector<std::uint8_t>;

// Values for the chip's requests.
constexpr std::uint16_t kPurgeReceived = 1;
constexpr std::uint16_t kPurgeSent = 2;
constexpr std::uint16_t kRequestToSendLow = 0x200;
constexpr std::uint16_t kTerminalReadyLow = 0x100;
constexpr std::uint16_t kTerminalReadyHigh = 0x101;
constexpr std::uint16_t kNoFlowControl = 0;
constexpr std::uint16_t kEightBitsNoParity = 8;
constexpr std::uint16_t kBaud9600 = 0x4138;
constexpr std::uint16_t kBaud140k = 0x15;
constexpr std::uint16_t kBaudRunning = 0x02;
constexpr std::uint16_t kLoadingLatencyMs = 16;
constexpr std::uint16_t kRunningLatencyMs = 1;

// The loader's two commands, and its answer to the first.
constexpr std::array<std::uint8_t, 3> kHello = {0x0a, 0x43, 0x0d};
constexpr std::array<std::uint8_t, 4> kHelloAnswer = {0x0a, 0x44, 0x2c, 0x0d};
constexpr std::array<std::uint8_t, 1> kStart = {0x41};

/// The payload of one packet, so that a block and its echo fit into one packet each.
constexpr std::size_t kBlockBytes = kUsbPacketSize - kFtdiStatusSize;

constexpr milliseconds kSendLimit{200};
/// Well above the latency timer, which sends a packet every 16 ms even if it is empty.
constexpr milliseconds kBootPacketLimit{50};
/// Empty packets after which no answer is expected.
constexpr int kTimeoutPackets = 2;

void purge(FtdiTransport& transport) {
  transport.control(FtdiRequest::purge, kPurgeReceived);
  transport.control(FtdiRequest::purge, kPurgeSent);
}

/// Appends the payload of the next packet.
/// \return whether it had a payload
bool receive_more(FtdiTransport& transport, Bytes& bytes) {
  std::array<std::uint8_t, kUsbPacketSize> packet{};
  const std::size_t length = transport.receive(packet, kBootPacketLimit);
  if (length <= kFtdiStatusSize) return false;
  bytes.insert(bytes.end(), packet.begin() + kFtdiStatusSize, packet.begin() + length);
  return true;
}

/// Receives this many bytes, or fewer at the time limit.
Bytes receive_bytes(FtdiTransport& transport, std::size_t count) {
  Bytes bytes;
  for (int idle = 0; bytes.size() < count && idle < kTimeoutPackets;) {
    idle = receive_more(transport, bytes) ? 0 : idle + 1;
  }
  return bytes;
}

/// Waits for an answer, possibly preceded by other bytes, for instance a zero.
/// \return whether it was received
bool receive_answer(FtdiTransport& transport, std::span<const std::uint8_t> expected) {
  Bytes bytes;
  for (int idle = 0; idle < kTimeoutPackets && bytes.size() < kUsbPacketSize;) {
    idle = receive_more(transport, bytes) ? 0 : idle + 1;
    if (std::search(bytes.begin(), bytes.end(), expected.begin(), expected.end()) != bytes.end())
      return true;
  }
  return false;
}

bool exchange_word(FtdiTransport& transport, std::span<const std::uint8_t> word,
                   std::span<const std::uint8_t> answer) {
  return transport.send(word, kSendLimit) == word.size() && receive_answer(transport, answer);
}

void reset_into_loader(FtdiTransport& transport) {
  purge(transport);
  transport.control(FtdiRequest::latency_timer, kLoadingLatencyMs);
  transport.control(FtdiRequest::baud_divisor, kBaud9600);
  transport.control(FtdiRequest::data_format, kEightBitsNoParity);
  transport.control(FtdiRequest::flow_control, kNoFlowControl);
  transport.control(FtdiRequest::modem_control, kRequestToSendLow);
  transport.control(FtdiRequest::modem_control, kTerminalReadyLow);
  transport.control(FtdiRequest::modem_control, kTerminalReadyHigh);
}

bool reach_loader(FtdiTransport& transport) {
  for (int attempt = 0; attempt < kFirmwareHandshakes; ++attempt) {
    if (exchange_word(transport, kHello, kHelloAnswer)) return true;
  }
  return false;
}

bool start_loader(FtdiTransport& transport) {
  transport.control(FtdiRequest::modem_control, kTerminalReadyLow);
  transport.control(FtdiRequest::baud_divisor, kBaud140k);
  return exchange_word(transport, kStart, kStart);
}

/// \return the first byte at which the echo differs; the image's size if none does
std::size_t send_image(FtdiTransport& transport, std::span<const std::uint8_t> image) {
  for (std::size_t offset = 0; offset < image.size(); offset += kBlockBytes) {
    const auto block = image.subspan(offset, std::min(kBlockBytes, image.size() - offset));
    if (transport.send(block, kSendLimit) != block.size()) return offset;
    if (!std::ranges::equal(block, receive_bytes(transport, block.size()))) return offset;
  }
  return image.size();
}

/// Loads the image once.
/// \return the failure; empty on success
std::string try_load(FtdiTransport& transport, std::span<const std::uint8_t> image) {
  reset_into_loader(transport);
  if (!reach_loader(transport)) return "its loader does not answer";
  if (!start_loader(transport)) return "its loader does not start";
  const std::size_t echoed = send_image(transport, image);
  if (echoed == image.size()) return {};
  return "its echo is wrong or missing from byte " + std::to_string(echoed) + " on";
}

}  // namespace

std::vector<std::uint8_t> read_falcon_firmware(const std::filesystem::path& file) {
  if (file.empty()) {
    throw FileError(
        "falcon: needs the vendor's firmware, but no file is named; set falcon.firmware in the "
        "device settings (docs/devices/falcon.md)");
  }
  std::ifstream stream(file, std::ios::binary);
  Bytes image(kMaxFirmwareBytes + 1);
  stream.read(reinterpret_cast<char*>(image.data()), static_cast<std::streamsize>(image.size()));
  image.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad() || (image.empty() && !stream.is_open())) {
    throw FileError(one_line(file.string()) +
                    ": cannot be read; correct falcon.firmware in the device settings");
  }
  if (image.size() < kMinFirmwareBytes || image.size() > kMaxFirmwareBytes) {
    throw FileError(one_line(file.string()) +
                    ": is not a Falcon's firmware, which has 4096 to 16384 bytes; correct "
                    "falcon.firmware in the device settings");
  }
  return image;
}

void load_falcon_firmware(FtdiTransport& transport, std::span<const std::uint8_t> image) {
  std::string failure;
  for (int load = 0; load < kFirmwareLoads; ++load) {
    failure = try_load(transport, image);
    if (failure.empty()) return set_up_running_falcon(transport);
  }
  throw DeviceError("falcon: its firmware could not be loaded in " +
                    std::to_string(kFirmwareLoads) + " attempts: " + failure +
                    "; unplug USB and power, wait ten seconds, plug both in and try again");
}

void set_up_running_falcon(FtdiTransport& transport) {
  transport.control(FtdiRequest::latency_timer, kRunningLatencyMs);
  transport.control(FtdiRequest::baud_divisor, kBaudRunning);
  purge(transport);
}

}  // namespace touchtrial::device::falcon

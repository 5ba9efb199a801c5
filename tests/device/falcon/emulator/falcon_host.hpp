/// \file The simplest host of an emulated Falcon: no USB, one thread, one reply per command.
#pragma once

#include "device/falcon/emulator/falcon_emulator.hpp"
#include "device/falcon/falcon_packet.hpp"

#include <array>
#include <optional>
#include <vector>

namespace touchtrial::device::falcon {

class FalconHost {
 public:
  explicit FalconHost(FalconEmulator& falcon) : falcon_(falcon) {}

  bool control(std::uint8_t request, std::uint16_t value) {
    return falcon_.control({0x40, request, value, 0}) == UsbStatus::ok;
  }

  /// \return the answer to some bytes, without status bytes
  std::vector<std::uint8_t> answer_to(std::vector<std::uint8_t> bytes) {
    static_cast<void>(falcon_.bulk_out(bytes));
    return payload();
  }

  std::vector<std::uint8_t> payload() {
    std::vector<std::uint8_t> transfer;
    static_cast<void>(falcon_.bulk_in(512, transfer));
    std::vector<std::uint8_t> bytes;
    for (std::size_t at = 0; at < transfer.size(); ++at) {
      if (at % kUsbPacketSize >= kFtdiStatusSize) bytes.push_back(transfer[at]);
    }
    return bytes;
  }

  void set_up_for_greeting() {
    constexpr std::array<std::array<std::uint16_t, 2>, 9> kRequests = {
        {{0, 1}, {0, 2}, {9, 16}, {3, 0x4138}, {4, 8}, {2, 0}, {1, 0x200}, {1, 0x100}, {1, 0x101}}};
    for (const auto& [request, value] : kRequests) {
      control(static_cast<std::uint8_t>(request), value);
    }
  }

  void set_up_for_loading() {
    control(1, 0x100);
    control(3, 0x15);
  }

  void set_up_for_running() {
    control(9, 1);
    control(3, 2);
    control(0, 1);
    control(0, 2);
  }

  /// \return nothing unless a whole reply came
  std::optional<Reply> exchange(const Command& command) {
    const Packet packet = encode_command(command);
    static_cast<void>(falcon_.bulk_out(packet));
    int replies = 0;
    do {
      std::vector<std::uint8_t> transfer;
      static_cast<void>(falcon_.bulk_in(64, transfer));
      replies += stream_.push_transfer(transfer);
    } while (falcon_.waiting() > 0);
    if (replies == 0) return std::nullopt;
    return stream_.newest();
  }

  [[nodiscard]] const FalconStream& stream() const { return stream_; }

 private:
  FalconEmulator& falcon_;
  FalconStream stream_;
};

}  // namespace touchtrial::device::falcon

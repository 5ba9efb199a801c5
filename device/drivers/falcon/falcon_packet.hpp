/// \file Packets of a running Falcon: a command of 16 bytes, and a reply of 16 bytes.
///
/// Format: '<', three int16 as four nibbles each (least significant first, plus 0x41), a byte of
/// flags plus 0x41, an unused byte, '>'. A command contains motor values, and flags for homing and
/// three LEDs. A reply contains encoder counts, and flags for four buttons and three homed axes.
/// Source: open-source drivers. Not verified on hardware.
///
/// Nothing here allocates or throws. Any thread may call the pure functions; a FalconStream belongs
/// to one thread.
#pragma once

#include "device/drivers/falcon/falcon_kinematics.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace touchtrial::device::falcon {

inline constexpr std::size_t kPacketSize = 16;
using Packet = std::array<std::uint8_t, kPacketSize>;

/// \name To the Falcon
///@{
using MotorValues = std::array<std::int16_t, 3>;  ///< from `FalconMotors`

/// Which lights are on.
struct Lights {
  bool red = false;
  bool green = false;
  bool blue = false;
};

/// \param order  the bits of red, green and blue, each 0 to 2; a bit out of range lights nothing
/// \return bits 0 to 2 of Command::leds
[[nodiscard]] std::uint8_t led_bits(const Lights& lights, const std::array<int, 3>& order) noexcept;

struct Command {
  MotorValues motors{};
  std::uint8_t leds = 0;  ///< from `led_bits`
  bool homing = true;     ///< lets axes home when a person moves them; always on
};

[[nodiscard]] Packet encode_command(const Command& command) noexcept;
///@}

/// \name From the Falcon
///@{
/// Bits of Reply::buttons.
enum Button : std::uint32_t {
  kButtonPlus = 1U << 0U,
  kButtonForward = 1U << 1U,
  kButtonCentre = 1U << 2U,
  kButtonMinus = 1U << 3U,
};

struct Reply {
  EncoderCounts counts{};
  std::uint32_t buttons = 0;    ///< bits of Button, set while down
  std::array<bool, 3> homed{};  ///< for each leg
  [[nodiscard]] bool all_homed() const noexcept { return homed[0] && homed[1] && homed[2]; }
};

/// \return the reply; nothing if a byte is invalid
[[nodiscard]] std::optional<Reply> decode_reply(
    std::span<const std::uint8_t, kPacketSize> packet) noexcept;
///@}

/// A bulk transfer from the FTDI chip consists of USB packets of 64 bytes; the last may be shorter.
inline constexpr std::size_t kUsbPacketSize = 64;
inline constexpr std::size_t kFtdiStatusSize = 2;  ///< at the beginning of each of these packets

/// Finds replies in the byte stream from a Falcon, even after lost bytes. Stores at most one
/// incomplete packet.
class FalconStream {
 public:
  /// Reads one bulk transfer, including the chip's status bytes.
  /// \return the number of completed replies; `newest` is the last of them
  int push_transfer(std::span<const std::uint8_t> transfer) noexcept;

  /// \return the last reply; a default one before the first
  [[nodiscard]] const Reply& newest() const noexcept { return newest_; }
  [[nodiscard]] std::uint64_t replies() const noexcept { return replies_; }
  /// \return the number of bytes outside replies, a measure of link quality
  [[nodiscard]] std::uint64_t discarded_bytes() const noexcept { return discarded_; }
  /// Discards an incomplete packet, after a purge of the chip's buffers.
  void restart() noexcept;

 private:
  bool push_byte(std::uint8_t byte) noexcept;
  void start_packet_at(std::uint8_t byte) noexcept;

  Packet packet_{};
  std::size_t size_ = 0;
  Reply newest_;
  std::uint64_t replies_ = 0;
  std::uint64_t discarded_ = 0;
};

}  // namespace touchtrial::device::falcon

/// \file A Falcon whose firmware runs: motors and encoders, with a hand on its grip.
///
/// Nobody has published the vendor's protocol, so each behaviour says where it comes from. "Open
/// driver" is libnifalcon: what its code does, where its comments say otherwise.
///
/// - 16 bytes to the Falcon bring 16 bytes back, and nothing else does (open driver, its notes on
///   the firmware). It never speaks first.
/// - Three int16 as four nibbles each, the least significant first, each plus 0x41 (open driver).
/// - Bit 0 of byte 13: homing, which Force Dimension's library asks for once, after loading, and
/// the
///   open driver in every command; both drive a Falcon. Bits 1 to 3: the green lamp 0x02, the blue
///   0x04, the red 0x08 (open driver, both its C and its C++ code; one of its comments gives
///   another order and is not what runs).
/// - Bits 0 to 3 of the reply: buttons, 4 to 6: axes homed (open driver).
/// - An axis homes when the grip is pulled all the way out and pushed in (open driver's advice to
///   its users). That 11 degrees of motion are enough is this emulator's choice.
/// - A motor's value is documented as capped at 4,096 (open driver's header); what the firmware
///   does beyond is unknown, so a greater one is a complaint here.
/// - 6,616 is 1 N m at the arm (Martin and Hillier 2009), against the encoder's sense (open
///   driver). One count is 0.0370066 degrees; the legs are those of Force Dimension's library.
/// - What the motors do when the host falls silent is unknown. The worst: they keep what they had.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::device::falcon {

/// Which lamps are on.
struct Lamps {
  bool red = false;
  bool green = false;
  bool blue = false;

  friend bool operator==(const Lamps&, const Lamps&) = default;
};

/// Called once for every exchange, which is one millisecond of the hand's time. Takes the force on
/// the hand, N, and returns its new place, mm, both in the device frame.
using HandModel = std::function<Vec3(Vec3 force_n)>;

/// Not thread-safe.
class RunningFalcon {
 public:
  static constexpr std::size_t kPacketSize = 16;
  using Packet = std::array<std::uint8_t, kPacketSize>;
  static constexpr int kMaxMotorValue = 4'095;
  /// An axis is homed when it has moved over this many counts: 11 degrees.
  static constexpr int kHomingTravel = 300;

  /// Asks the hand for its first position.
  explicit RunningFalcon(HandModel hand, bool homed);

  /// Receives bytes from the host.
  /// \return a reply for every command among them
  [[nodiscard]] std::vector<Packet> receive(std::span<const std::uint8_t> bytes);
  /// Discards an incomplete command.
  void purge() { received_.clear(); }

  /// \name For acts of a test
  ///@{
  void press(std::uint32_t buttons) { buttons_ = buttons & 15U; }
  void stick_encoders(bool stuck) { stuck_ = stuck; }
  void set_hand(HandModel hand) { hand_ = std::move(hand); }
  void forget_homing();
  /// The host is gone: an incomplete command is forgotten.
  void cut_cable() { received_.clear(); }
  ///@}

  /// \name For checks of a test
  ///@{
  [[nodiscard]] std::uint64_t exchanges() const { return exchanges_; }
  [[nodiscard]] Vec3 position_mm() const;  ///< of the grip, device frame
  [[nodiscard]] Vec3 force_n() const { return force_n_; }
  [[nodiscard]] const std::array<std::int16_t, 3>& motors() const { return motors_; }
  [[nodiscard]] Lamps lamps() const { return lamps_; }
  [[nodiscard]] bool all_homed() const { return homed_[0] && homed_[1] && homed_[2]; }
  /// \return what would damage a real device, or what it would silently misread, one line each
  [[nodiscard]] const std::vector<std::string>& complaints() const { return complaints_; }
  ///@}

 private:
  [[nodiscard]] Packet exchange();
  void take_command();
  void move_hand();
  void home_axes();
  [[nodiscard]] Packet reply() const;
  void complain(const std::string& what);

  HandModel hand_;
  std::vector<std::uint8_t> received_;
  Vec3 native_m_;
  Vec3 force_n_;
  std::array<std::int16_t, 3> motors_{};
  std::array<int, 3> counts_{};    ///< from the true origin
  std::array<int, 3> origin_{};    ///< added to the counts before an axis is homed
  std::array<int, 3> least_{};     ///< since homing began
  std::array<int, 3> greatest_{};  ///< likewise
  std::array<bool, 3> homed_{};
  bool homing_ = false;  ///< a command asked for it
  bool travel_begun_ = false;
  bool stuck_ = false;
  Lamps lamps_;
  std::uint32_t buttons_ = 0;
  std::uint64_t exchanges_ = 0;
  std::vector<std::string> complaints_;
};

}  // namespace touchtrial::device::falcon

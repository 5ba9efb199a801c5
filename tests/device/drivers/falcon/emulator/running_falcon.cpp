#include "device/drivers/falcon/emulator/running_falcon.hpp"

#include "device/drivers/falcon/emulator/falcon_legs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace touchtrial::device::falcon {
namespace {

constexpr double kCentreHeightM = 0.155;
constexpr double kNmPerMotorValue = -1.0 / 6616.0;
/// Where the encoders begin before they are homed.
constexpr std::array<int, 3> kUnhomedOrigin = {1234, -777, 2468};

Vec3 native_of_mm(Vec3 mm) {
  return {mm.x / 1000.0, mm.y / 1000.0, mm.z / 1000.0 + kCentreHeightM};
}

int count_of(double theta1_rad) {
  return static_cast<int>(
      std::lround((theta1_rad * 180.0 / std::numbers::pi - 32.9895) * 9728.0 / 360.0));
}

int nibble(std::uint8_t byte) {
  return byte >= 0x41 && byte <= 0x50 ? byte - 0x41 : -1;
}

/// \return a motor value of four nibbles; nothing if one of them is invalid
std::optional<std::int16_t> motor_value(std::span<const std::uint8_t> nibbles) {
  int value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    const int digit = nibble(nibbles[i]);
    if (digit < 0) return std::nullopt;
    value = value * 16 + digit;
  }
  return static_cast<std::int16_t>(value >= 0x8000 ? value - 0x10000 : value);
}

}  // namespace

RunningFalcon::RunningFalcon(HandModel hand, bool homed) : hand_(std::move(hand)) {
  native_m_ = {0.0, 0.0, kCentreHeightM};
  move_hand();
  if (homed) {
    homed_.fill(true);
    homing_ = true;
  } else {
    forget_homing();
  }
}

void RunningFalcon::forget_homing() {
  homed_.fill(false);
  homing_ = travel_begun_ = false;
  origin_ = kUnhomedOrigin;
}

Vec3 RunningFalcon::position_mm() const {
  return 1000.0 * (native_m_ - Vec3{0.0, 0.0, kCentreHeightM});
}

std::vector<RunningFalcon::Packet> RunningFalcon::receive(std::span<const std::uint8_t> bytes) {
  std::vector<Packet> replies;
  for (const std::uint8_t byte : bytes) {
    if (received_.empty() && byte != '<') {
      complain("a byte outside a command");
      continue;
    }
    received_.push_back(byte);
    if (received_.size() < kPacketSize) continue;
    if (byte == '>') {
      replies.push_back(exchange());
    } else {
      complain("a command without its end mark");
    }
    received_.clear();
  }
  return replies;
}

RunningFalcon::Packet RunningFalcon::exchange() {
  take_command();
  const auto force =
      reference_force_n(native_m_, {kNmPerMotorValue * motors_[0], kNmPerMotorValue * motors_[1],
                                    kNmPerMotorValue * motors_[2]});
  force_n_ = force.value_or(Vec3{});
  move_hand();
  home_axes();
  ++exchanges_;
  return reply();
}

void RunningFalcon::take_command() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = motor_value(std::span(received_).subspan(1 + 4 * axis, 4));
    if (!value) complain("a motor value that is none");
    motors_[axis] = value.value_or(0);
    if (std::abs(int{motors_[axis]}) > kMaxMotorValue) complain("a motor value beyond 4,095");
  }
  const int flags = nibble(received_[13]);
  if (flags < 0) complain("flags that are none");
  homing_ = homing_ || (flags >= 0 && flags % 2 == 1);
  const unsigned bits = flags < 0 ? 0U : static_cast<unsigned>(flags);
  lamps_ = {.red = (bits & 0x08U) != 0, .green = (bits & 0x02U) != 0, .blue = (bits & 0x04U) != 0};
  if (!homing_) complain("a command before one for homing");
  if (!all_homed() && motors_ != std::array<std::int16_t, 3>{}) complain("force before homing");
}

void RunningFalcon::move_hand() {
  const Vec3 wanted_m = native_of_mm(hand_(force_n_));
  const auto angles = reference_theta1(wanted_m);
  if (!angles) {
    complain("the hand pulls beyond the reach");
    return;
  }
  native_m_ = wanted_m;
  if (stuck_) return;
  for (std::size_t axis = 0; axis < 3; ++axis) counts_[axis] = count_of((*angles)[axis]);
}

void RunningFalcon::home_axes() {
  if (!homing_) return;
  const bool begins = !std::exchange(travel_begun_, true);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    least_[axis] = begins ? counts_[axis] : std::min(least_[axis], counts_[axis]);
    greatest_[axis] = begins ? counts_[axis] : std::max(greatest_[axis], counts_[axis]);
    if (greatest_[axis] - least_[axis] >= kHomingTravel) homed_[axis] = true;
  }
}

RunningFalcon::Packet RunningFalcon::reply() const {
  Packet packet;
  packet.fill(0x41);
  packet[0] = '<';
  unsigned flags = buttons_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int count = counts_[axis] + (homed_[axis] ? 0 : origin_[axis]);
    for (std::size_t i = 0; i < 4; ++i) {
      packet[1 + 4 * axis + i] =
          static_cast<std::uint8_t>(0x41U + (static_cast<unsigned>(count) >> (4 * i) & 15U));
    }
    if (homed_[axis]) flags += 16U << axis;
  }
  packet[13] = static_cast<std::uint8_t>(0x41U + flags);
  packet[15] = '>';
  return packet;
}

void RunningFalcon::complain(const std::string& what) {
  if (std::find(complaints_.begin(), complaints_.end(), what) == complaints_.end()) {
    complaints_.push_back(what);
  }
}

}  // namespace touchtrial::device::falcon

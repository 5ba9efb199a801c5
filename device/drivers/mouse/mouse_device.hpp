/// \file Pseudo-haptics with a mouse: forces displace and slow the pointer on a screen. Visual,
/// hence not blind: for demonstrations and pilot sessions. Sources: Lecuyer, Burkhardt and Etienne,
/// "Feeling bumps and holes without a haptic interface: the perception of pseudo-haptic textures",
/// CHI 2004; docs/devices/mouse.md.
#pragma once

#include "device/drivers/mouse/pointer_exchange.hpp"
#include "device/haptic_device.hpp"
#include "device/servo/servo_clock.hpp"

#include <atomic>

namespace touchtrial::device {

/// The name of the driver.
inline constexpr const char* kMouseDriver = "mouse";

/// A critically damped mass on a spring whose far end moves: two first-order lags in series, by the
/// implicit Euler method. The value is always a weighted mean of past targets, so it stays within
/// their bounds and never overshoots a constant target.
class SmoothPull {
 public:
  /// \param time_constant_s  of either lag, > 0; the spring's natural frequency is
  ///   1 / (2 pi time_constant_s)
  explicit SmoothPull(double time_constant_s) noexcept : time_constant_s_(time_constant_s) {}

  /// \param step_s  time since the last step, >= 0
  void step(Vec2 target, double step_s) noexcept {
    const double share = step_s / (time_constant_s_ + step_s);
    middle_ = middle_ + share * (target - middle_);
    const Vec2 change = share * (middle_ - value_);
    value_ = value_ + change;
    if (step_s > 0.0) rate_ = (1.0 / step_s) * change;
  }

  /// Sets the value, at rest.
  void reset(Vec2 value) noexcept {
    middle_ = value;
    value_ = value;
    rate_ = {};
  }

  [[nodiscard]] Vec2 value() const noexcept { return value_; }
  [[nodiscard]] Vec2 rate_per_s() const noexcept { return rate_; }

 private:
  double time_constant_s_;
  Vec2 middle_;
  Vec2 value_;
  Vec2 rate_;
};

/// The compliance of the stylus. With the defaults coarse textures are distinguishable:
/// docs/devices/mouse.md.
struct MouseOptions {
  double pull_n_per_mm = 0.025;   ///< spring to the pointer: 0.1 N displaces by 4 mm; > 0
  double max_pull_n = 0.3;        ///< tangential forces above it have no further effect, > 0
  double pull_time_s = 0.010;     ///< time constant of the stylus on that spring: 16 Hz, > 0
  double pointer_time_s = 0.006;  ///< smooths the pointer's steps, > 0
  double max_speed_mm_s = 800.0;  ///< at which the hand follows the pointer, > 0
  double push_n = 0.7;            ///< on the plane while the button is held, > 0
  double push_time_s = 0.1;       ///< rise and fall time of the push, > 0
  /// Height above the plane while the button is not held, > 0; higher than a landed stylus.
  double hover_mm = 3.5;
};

/// The driver "mouse", in the plane frame. The hand follows the pointer. A critically damped spring
/// ties the stylus to the hand, and tangential forces displace the stylus: it lags uphill, jumps
/// ahead downhill, and returns without force. While the button is held, a hand of 0.1 kg descends
/// and pushes; it sinks into the wall until the wall's force equals `push_n`. Stable at 1 to 10 kHz
/// with any wall or texture of up to 10 N/mm. With the defaults no motion is faster than
/// 1,700 mm/s, for any pointer motion and force.
///
/// The device never waits for a window. If the window hangs for kTimeout, the hand rises; if the
/// window closes, the link is lost.
class MouseDevice final : public HapticDevice {
 public:
  static constexpr ServoClock::Time kTimeout = std::chrono::milliseconds(500);
  /// The maximum depth of the hand without a wall, and its maximum height, mm.
  static constexpr double kReachMm = 10.0;

  /// \param pointer,clock  must outlive this; the device only reads the clock
  /// \throws std::invalid_argument if an option is out of range
  MouseDevice(PointerSource& pointer, ServoClock& clock, const MouseOptions& options = {});

  [[nodiscard]] DeviceInfo info() const override;
  /// Advances the stylus by the time since the last reading. Samples are not ready before the
  /// window's first state.
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// Also raises the hand.
  void halt() noexcept override { halted_.store(true, std::memory_order_release); }
  void rearm() noexcept override { halted_.store(false, std::memory_order_release); }
  [[nodiscard]] DeviceFault fault() const noexcept override;

 private:
  void update_pointer(const PointerState& pointer, ServoClock::Time now) noexcept;
  /// Raises the hand above the plane at once.
  void raise_hand() noexcept;
  void move(double step_s) noexcept;
  void move_vertically(double step_s, double normal_force_n) noexcept;

  PointerSource& pointer_;
  ServoClock& clock_;
  MouseOptions options_;
  ServoClock::Time last_read_{};
  ServoClock::Time last_change_{};  ///< time of the window's last new state
  PointerState pointer_state_;
  bool is_pressed_ = false;
  Vec2 hand_mm_;             ///< follows the pointer at up to max_speed_mm_s
  SmoothPull smoothed_;      ///< the hand, without the pointer's steps
  SmoothPull displacement_;  ///< of the stylus by tangential forces
  double push_share_ = 0.0;  ///< of push_time_s, 0 to 1
  double height_mm_;
  double rise_mm_s_ = 0.0;
  Vec3 force_n_;
  std::uint64_t readings_ = 0;
  std::atomic<bool> halted_{false};
  std::atomic<bool> closed_{false};
};

}  // namespace touchtrial::device

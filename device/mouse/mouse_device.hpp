/// \file Texture without a haptic device: a pointer whose own motion the forces displace and slow.
/// Visual, hence not blind: for demonstration and pilot sessions. Sources: Lecuyer, Burkhardt and
/// Etienne, "Feeling bumps and holes without a haptic interface: the perception of pseudo-haptic
/// textures", CHI 2004; docs/devices/mouse.md.
#pragma once

#include "device/haptic_device.hpp"
#include "device/mouse/pointer_source.hpp"
#include "device/mouse/smooth_pull.hpp"
#include "device/servo/servo_clock.hpp"

#include <atomic>

namespace touchtrial::device {

/// How the stylus yields. The defaults let coarse textures be told apart: docs/devices/mouse.md.
struct MouseOptions {
  double pull_n_per_mm = 0.025;   ///< of the spring back to the pointer: 0.1 N shows as 4 mm; > 0
  double greatest_pull_n = 0.3;   ///< more tangential force displaces no further, > 0
  double pull_time_s = 0.010;     ///< of the stylus on that spring: 16 Hz, > 0
  double pointer_time_s = 0.006;  ///< smooths the steps in which a pointer comes, > 0
  double greatest_speed_mm_s = 800.0;  ///< of the pointer as the stylus follows it, > 0
  double push_n = 0.7;                 ///< on the plane while the button is held, > 0
  double push_time_s = 0.1;            ///< in which the push comes and goes, > 0
  double hover_mm = 2.0;               ///< above the plane while it is not held, > 0
};

/// The driver "mouse", in the plane frame. The hand is where the pointer is; the stylus hangs on a
/// spring from it, critically damped, and every tangential force displaces it: it lags uphill, is
/// slowed by a force against its motion, jumps ahead downhill, and returns when the force is gone.
/// Pressing lets a hand of 0.1 kg come down and push; the wall's force carries it, so it sinks
/// until the load is `push_n`. Stable at 1 to 10 kHz with any wall or texture of up to 10 N/mm; no
/// motion is faster than 1,700 mm/s with the defaults, whatever pointer or force do.
///
/// It never waits for a window. One that hangs for kPatience is a hand that lets go; one that has
/// closed is a lost link.
class MouseDevice final : public HapticDevice {
 public:
  static constexpr ServoClock::Time kPatience = std::chrono::milliseconds(500);
  /// Nor does the hand go deeper where there is no wall, or rise further than this, mm.
  static constexpr double kReachMm = 10.0;

  /// \param pointer, clock  must outlive this; the clock is asked for the time alone
  /// \throws std::invalid_argument if an option is out of range
  MouseDevice(PointerSource& pointer, ServoClock& clock, const MouseOptions& options = {});

  [[nodiscard]] DeviceInfo info() const override;
  /// Moves the stylus on by the time since the last reading. Not ready until the window has begun.
  [[nodiscard]] DeviceStatus read(DeviceSample& sample) noexcept override;
  [[nodiscard]] DeviceStatus write(Vec3 force_n) noexcept override;
  /// The hand lets go as well.
  void halt() noexcept override { halted_.store(true, std::memory_order_release); }
  void rearm() noexcept override { halted_.store(false, std::memory_order_release); }
  [[nodiscard]] DeviceFault fault() const noexcept override;

 private:
  void look_at(const PointerState& pointer, ServoClock::Time now) noexcept;
  void move(double step_s) noexcept;
  void move_across(double step_s, double normal_force_n) noexcept;

  PointerSource& pointer_;
  ServoClock& clock_;
  MouseOptions options_;
  ServoClock::Time last_read_{};
  ServoClock::Time news_at_{};  ///< when the pointer last showed that its window lives
  PointerState seen_;
  bool pressed_ = false;
  Vec2 hand_mm_;         ///< the pointer, at no more than the greatest speed
  SmoothPull followed_;  ///< the hand, without the pointer's steps
  SmoothPull displaced_;
  double push_share_ = 0.0;  ///< of the time in which the push comes, 0 to 1
  double height_mm_;
  double rise_mm_s_ = 0.0;
  Vec3 force_n_;
  std::uint64_t readings_ = 0;
  std::atomic<bool> halted_{false};
  std::atomic<bool> closed_{false};
};

}  // namespace touchtrial::device

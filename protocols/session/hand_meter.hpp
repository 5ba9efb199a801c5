/// \file How the hand presses and strokes while a plane is on, in words for the experimenter.
#pragma once

#include "device/servo/servo.hpp"
#include "protocols/session/experimenter.hpp"
#include "study/study.hpp"

#include <atomic>
#include <cstdint>
#include <optional>

namespace touchtrial::session {

/// Means over about half a second of what the hand does by itself: its force across the plane,
/// which over that time is its push whatever the relief, and its speed along the plane, over steps
/// of 50 ms in which a texture moves it little. They are compared with what participants are told.
/// Nothing but words leaves this object, so that they tell of the hand what everybody sees who
/// looks at it, and nothing of the texture. Source: docs/decisions/0054-what-a-trial-shows.md.
class HandMeter {
 public:
  /// \param rule  its windows of force hold too, where they are narrower than the instructions
  /// \param rate_hz  of the servo, > 0
  HandMeter(const study::ValidityRule& rule, double rate_hz) noexcept;

  /// Forgets the hand. Not while another thread calls `feel`.
  void begin() noexcept;
  /// Takes a sample of the plane frame. The thread that receives the servo's samples.
  void feel(const device::ServoSample& sample) noexcept;
  /// Any thread.
  /// \return nothing until the hand has been at the plane (at most kLandingHeightMm above it) for
  ///   half a second
  [[nodiscard]] std::optional<HandLevels> levels() const noexcept;

 private:
  void end_step(const device::ServoSample& last) noexcept;
  void tell() noexcept;

  double least_n_;
  double largest_n_;
  double rate_hz_;
  std::int64_t step_ticks_;

  std::int64_t samples_ = 0;   ///< of this step
  double force_n_ = 0.0;       ///< their sum
  device::ServoSample first_;  ///< of this step
  int steps_ = 0;              ///< so far, counted up to kWholeSteps
  double mean_n_ = 0.0;
  double mean_mm_s_ = 0.0;
  /// 0: nothing; else 1 + 3 * force + speed.
  std::atomic<std::uint8_t> told_{0};
};

}  // namespace touchtrial::session

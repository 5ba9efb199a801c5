/// \file Measures the hand's force and speed for the experimenter.
#pragma once

#include "device/servo/servo.hpp"
#include "protocols/session/experimenter.hpp"
#include "study/study.hpp"

#include <atomic>
#include <cstdint>
#include <optional>

namespace touchtrial::session {

/// Averages the hand's force normal to the plane and its speed along the plane over about half a
/// second, and compares both with the instructions. Over that time, the mean force equals the
/// hand's push for any relief; speeds are measured over steps of 50 ms, in which a texture hardly
/// moves the hand. Only the levels are public, so that they reveal no more than a look at the hand.
/// Source: docs/decisions/0054-what-a-trial-shows.md.
class HandMeter {
 public:
  /// \param rule  its force limits apply if they are narrower than the instructions
  /// \param rate_hz  the servo's rate, > 0
  HandMeter(const study::ValidityRule& rule, double rate_hz) noexcept;

  /// Resets the means. Must not run concurrently with `feel`.
  void begin() noexcept;
  /// Adds a sample in the plane frame. Call on the thread that receives the servo's samples.
  void feel(const device::ServoSample& sample) noexcept;
  /// The current levels. Thread-safe.
  /// \return nothing until the hand has been at the plane (at most kLandingHeightMm above it) for
  ///   half a second
  [[nodiscard]] std::optional<HandLevels> levels() const noexcept;

 private:
  void end_step(const device::ServoSample& last_sample) noexcept;
  void publish_levels() noexcept;

  double min_n_;
  double max_n_;
  double rate_hz_;
  std::int64_t step_ticks_;

  std::int64_t samples_ = 0;          ///< in this step
  double force_n_ = 0.0;              ///< sum over this step
  device::ServoSample first_sample_;  ///< first sample of this step
  int steps_ = 0;                     ///< completed steps, up to kMeanSteps
  double mean_n_ = 0.0;
  double mean_mm_s_ = 0.0;
  /// 0: no levels; else 1 + 3 * force + speed.
  std::atomic<std::uint8_t> levels_{0};
};

}  // namespace touchtrial::session

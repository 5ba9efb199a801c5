/// \file The measurements of an acceptance. Each is force source and sample sink of one servo run.
///   Source: docs/devices/acceptance.md.
#pragma once

#include "core/vec.hpp"
#include "device/servo/servo.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

/// Axes of the device frame, in test order: y first, where a weight hangs without a pulley.
enum class DeviceAxis { y, x, z };
inline constexpr std::array kDeviceAxes = {DeviceAxis::y, DeviceAxis::x, DeviceAxis::z};
[[nodiscard]] std::string_view name_of(DeviceAxis axis) noexcept;
/// \return a vector of length 1
[[nodiscard]] Vec3 direction_of(DeviceAxis axis) noexcept;

/// One run. Belongs to the servo thread during the run, except `done`. Until the device is ready,
/// it sends no force and its time does not advance.
class Measurement : public ForceSource, public SampleSink {
 public:
  Measurement(const Measurement&) = delete;
  Measurement& operator=(const Measurement&) = delete;

  /// The maximum duration.
  [[nodiscard]] double seconds() const noexcept { return seconds_; }
  /// Whether it is complete or was cancelled; its force is then zero.
  [[nodiscard]] bool done() const noexcept { return done_.load(std::memory_order_acquire); }
  /// Whether the force was switched off because the handle moved too far from its start.
  [[nodiscard]] bool has_run_away() const noexcept { return has_run_away_; }
  /// Every tick of the run, in order.
  [[nodiscard]] std::span<const ServoSample> samples() const noexcept { return samples_; }

  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept final;
  void record(const ServoSample& sample) noexcept final;

 protected:
  /// \param seconds  > 0
  /// \param max_n  of the force's norm, >= 0
  /// \param reach_mm  maximum distance of the handle from its start
  Measurement(double seconds, double max_n, double reach_mm);

  /// \param time_s  since the first ready sample
  [[nodiscard]] virtual Vec3 next_n(const DeviceSample& sample, double time_s) noexcept = 0;
  void finish() noexcept { done_.store(true, std::memory_order_release); }
  /// The position of the first ready sample.
  [[nodiscard]] Vec3 start_mm() const noexcept { return start_mm_; }

 private:
  double seconds_;
  double max_n_;
  double reach_mm_;
  std::int64_t ticks_ = 0;
  Vec3 start_mm_;
  bool has_run_away_ = false;
  std::atomic<bool> done_{false};
  std::vector<ServoSample> samples_;
};

/// Detects an oscillation in a hand's motion: after a second-order high-pass at 12 Hz, eight half
/// swings within 0.45 s whose amplitude does not fall to half of the first. Private to this folder.
class SwingDetector {
 public:
  /// \param min_mm  smaller swings are ignored
  explicit SwingDetector(double min_mm) noexcept : min_mm_(min_mm) {}
  /// Adds the position of a tick; call it at every tick.
  /// \return whether an oscillation is detected
  [[nodiscard]] bool update(double position_mm, double time_s) noexcept;

 private:
  double min_mm_;
  bool has_position_ = false;
  std::array<double, 2> slow_mm_{};   ///< states of the high-pass
  double peak_mm_ = 0.0;              ///< of the current half swing, signed
  std::array<double, 8> peaks_mm_{};  ///< of the last half swings
  std::array<double, 8> times_s_{};
  std::size_t half_swings_ = 0;
};

/// Detects a floor that throws the handle up repeatedly, at two to nine rebounds per second,
/// because of too much delay: four rebounds that do not decay. Bounces after a landing decay.
/// Private to this folder.
class ReboundDetector {
 public:
  static constexpr double kMinMm = 1.0;  ///< lower rebounds are ignored
  /// Rebounds have decayed if the fourth is at most this share of the first.
  static constexpr double kDecayedRatio = 0.7;
  /// Adds the height of a tick; call it at every tick.
  /// \return whether four rebounds have not decayed
  [[nodiscard]] bool update(double height_mm) noexcept;

 private:
  bool has_landed_ = false;
  double highest_mm_ = 0.0;  ///< since the handle left the floor
  std::array<double, 4> rebounds_mm_{};
  std::size_t rebounds_ = 0;
};

/// Records without force while the handle is at rest or a person moves it.
class PassiveRun final : public Measurement {
 public:
  explicit PassiveRun(double seconds);

  /// The number of new readings since the first ready one, by DeviceSample::sequence.
  [[nodiscard]] std::uint64_t new_readings() const noexcept {
    return newest_sequence_ - first_sequence_;
  }
  /// The longest sequence of ticks without a new reading.
  [[nodiscard]] int longest_gap_ticks() const noexcept { return longest_gap_; }

 private:
  [[nodiscard]] Vec3 next_n(const DeviceSample& sample, double time_s) noexcept override;

  bool has_reading_ = false;
  std::uint64_t first_sequence_ = 0;
  std::uint64_t newest_sequence_ = 0;
  int gap_ = 0;
  int longest_gap_ = 0;
};

/// Pushes along an axis in steps of kStepN until the handle has moved by kMovedMm, in one
/// direction, then in the other. It ends at once if the handle moves against the force.
class AxisPush final : public Measurement {
 public:
  static constexpr double kStepN = 0.1;
  static constexpr double kStepS = 0.2;    ///< time of a step
  static constexpr double kMovedMm = 2.0;  ///< motion that ends a push
  static constexpr double kMaxN = 1.5;     ///< even if the device can exert more

  struct Push {
    double force_n = 0.0;  ///< of the last step
    bool moved = false;    ///< by kMovedMm; else the force was too small
    Vec3 moved_mm;
  };
  struct Figures {
    bool reached_rest = false;  ///< before the force, so that later motion is due to the force
    std::optional<Push> plus;
    std::optional<Push> minus;
  };

  /// \param max_n  > 0; limited to kMaxN
  AxisPush(DeviceAxis axis, double max_n);
  /// Call after the run.
  [[nodiscard]] const Figures& figures() const noexcept { return figures_; }

 private:
  [[nodiscard]] Vec3 next_n(const DeviceSample& sample, double time_s) noexcept override;
  void wait_for_rest(double time_s) noexcept;
  void end_push(bool moved, double force_n) noexcept;

  Vec3 direction_;
  double max_step_n_;
  int sign_ = 1;
  bool is_pushing_ = false;
  double phase_start_s_ = 0.0;  ///< start of rest or push
  double wait_start_s_ = 0.0;   ///< start of the wait for rest
  bool has_position_ = false;
  Vec3 smoothed_mm_;  ///< position without the encoder's noise
  Vec3 rest_mm_;      ///< position at rest
  Figures figures_;
};

/// A spring and a damper that hold the handle in place.
struct HoldGains {
  double spring_n_per_mm = 0.3;
  double damper_n_s_per_mm = 0.003;
};

/// Holds the handle and moves it slowly to and fro along an axis, to separate friction, which
/// changes sign with the motion, from a load, which does not. The handle is released if it
/// oscillates.
class SlowStrokes final : public Measurement {
 public:
  static constexpr double kPeriodS = 3.0;
  static constexpr double kAmplitudeMm = 5.0;  ///< of the triangle wave of the target position
  static constexpr double kSpeedMmS = 4.0 * kAmplitudeMm / kPeriodS;
  static constexpr int kPeriods = 3;
  static constexpr double kReleaseS = 2.5;  ///< time for the hand to let go before the strokes

  /// \param support_n  force that supports a known load, in addition to the spring
  /// \param max_n  of the force's norm
  /// \param hold_s  how long the handle is held before the strokes, >= kReleaseS
  SlowStrokes(DeviceAxis axis, Vec3 support_n, const HoldGains& gains, double max_n,
              double hold_s = kReleaseS);

  [[nodiscard]] DeviceAxis axis() const noexcept { return axis_; }
  [[nodiscard]] double hold_s() const noexcept { return hold_s_; }
  [[nodiscard]] bool has_swung() const noexcept { return has_swung_; }

 private:
  [[nodiscard]] Vec3 next_n(const DeviceSample& sample, double time_s) noexcept override;

  DeviceAxis axis_;
  Vec3 support_n_;
  HoldGains gains_;
  double hold_s_;
  bool has_swung_ = false;
  std::array<SwingDetector, 3> detectors_;
};

/// Pushes the free handle to and fro along an axis by a constant force that reverses after ever
/// shorter distances: a chirp whose rate depends on the handle. In other directions it is held.
class ShakenStrokes final : public Measurement {
 public:
  static constexpr double kShakeS = 10.0;
  static constexpr double kMaxStrokeMm = 16.0;
  static constexpr double kMinStrokeMm = 5.0;

  /// \param push_n  > 0
  ShakenStrokes(DeviceAxis axis, Vec3 support_n, double push_n, const HoldGains& gains,
                double max_n);

  [[nodiscard]] DeviceAxis axis() const noexcept { return axis_; }
  [[nodiscard]] double push_n() const noexcept { return push_n_; }
  /// Start of the shaken samples.
  [[nodiscard]] static constexpr double shake_start_s() noexcept { return SlowStrokes::kReleaseS; }

 private:
  [[nodiscard]] Vec3 next_n(const DeviceSample& sample, double time_s) noexcept override;

  DeviceAxis axis_;
  Vec3 support_n_;
  double push_n_;
  HoldGains gains_;
  int sign_ = 1;
  double turn_s_ = 0.0;
  double turn_mm_ = 0.0;
};

/// Renders a floor below the handle, on which a person presses continuously. An oscillation, or
/// rebounds that do not decay, end it at once.
class WallTrial final : public Measurement {
 public:
  static constexpr double kTrialS = 6.0;
  static constexpr double kDepthMm = 3.0;  ///< of the floor below the handle's start

  /// \param min_mm  smaller swings are ignored
  WallTrial(double stiffness_n_per_mm, double min_mm, double max_n);

  [[nodiscard]] bool has_oscillated() const noexcept { return has_oscillated_; }
  /// Time in contact.
  [[nodiscard]] double contact_s() const noexcept { return contact_s_; }

 private:
  [[nodiscard]] Vec3 next_n(const DeviceSample& sample, double time_s) noexcept override;

  double stiffness_;
  SwingDetector detector_;
  ReboundDetector rebounds_;
  double contact_s_ = 0.0;
  bool has_oscillated_ = false;
};

/// Exerts a small constant force while a person watches the device.
class SteadyPush final : public Measurement {
 public:
  static constexpr double kForceN = 0.3;

  /// \param reach_mm  maximum distance of the handle from its start
  explicit SteadyPush(double seconds, Vec3 force_n = {0.0, -kForceN, 0.0}, double reach_mm = 200.0);

 private:
  [[nodiscard]] Vec3 next_n(const DeviceSample& sample, double time_s) noexcept override;

  Vec3 force_n_;
};

}  // namespace touchtrial::device

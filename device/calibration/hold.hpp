/// \file The measurement behind a calibration: holds a device's tip at one place and measures the
/// force that it takes. Source: docs/devices/README.md, "Calibrate".
#pragma once

#include "core/vec.hpp"
#include "device/servo/servo.hpp"

namespace touchtrial::device {

/// Means over the steady end of a run, device frame.
struct HoldFigures {
  bool measured = false;  ///< the run lasted long enough, and the device was ready
  Vec3 force_n;           ///< mean of the sent forces
  double noise_mm = 0.0;  ///< standard deviation of the position, all axes together
  double drift_mm = 0.0;  ///< from the mean place of the first half to that of the second
};

/// One run: force source and sample sink in one. Holds the place of its first ready sample by a
/// spring, a damper and an integral, so that at rest the mean force balances the load, whatever the
/// spring. For masses of 50 to 500 g. Belongs to the servo thread while a run lasts.
class HoldMeasurement final : public ForceSource, public SampleSink {
 public:
  enum class Mode {
    hold,
    rest,  ///< without force: the handle lies still
  };
  static constexpr double kSettleS = 6.0;   ///< not measured: the hand lets go, the integral fills
  static constexpr double kMeasureS = 2.0;  ///< averaged
  static constexpr double kRunS = kSettleS + kMeasureS;

  explicit HoldMeasurement(Mode mode, double rate_hz = kServoRateHz) noexcept
      : mode_(mode), rate_hz_(rate_hz) {}

  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept override;
  void record(const ServoSample& sample) noexcept override;

  /// After the run.
  [[nodiscard]] HoldFigures figures() const noexcept;

 private:
  struct Half {
    std::int64_t ticks = 0;
    Vec3 position_mm;  ///< sum
    Vec3 force_n;      ///< sum
  };

  Mode mode_;
  double rate_hz_;
  bool holding_ = false;
  Vec3 place_mm_;
  Vec3 integral_n_;
  Half halves_[2];
  double squares_mm2_ = 0.0;  ///< sum, about the place
};

}  // namespace touchtrial::device

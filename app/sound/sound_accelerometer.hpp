/// \file An accelerometer whose conditioner is plugged into the computer's sound input.
#pragma once

#include "device/acceptance/accelerometer.hpp"

#include <memory>
#include <string>
#include <vector>

namespace touchtrial::app {

/// Records up to 30 s at 48 kHz, and keeps the means of every four samples, which are 1 % too low
/// at 1 kHz, above which nothing is felt. Belongs to one thread; samples come on the sound card's
/// own.
class SoundAccelerometer final : public device::Accelerometer {
 public:
  static constexpr double kInputHz = 48000.0;
  static constexpr int kMeanOf = 4;  ///< samples
  static constexpr double kRateHz = kInputHz / kMeanOf;

  /// Opens the input.
  /// \param name  of the input, or a part of it
  /// \param full_scale_m_s2  acceleration at the end of the input's range, a channel each: one for
  ///   one axis, three for x, y and z; > 0
  /// \throws DeviceError with the inputs that there are, UsageError if the scales are not these
  SoundAccelerometer(const std::string& name, std::vector<double> full_scale_m_s2);
  ~SoundAccelerometer() override;

  void start() override;
  [[nodiscard]] device::AccelerometerRecord stop() override;

 private:
  struct Input;
  std::unique_ptr<Input> input_;
};

/// The record of interleaved samples in [-1, 1].
/// \param full_scale_m_s2  by channel, as above
[[nodiscard]] device::AccelerometerRecord record_of_sound(
    const std::vector<float>& samples, const std::vector<double>& full_scale_m_s2);

}  // namespace touchtrial::app

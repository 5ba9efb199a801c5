/// \file Published detection thresholds for vibrations of a held stylus. They were measured with
/// steady vibrations of a resting hand; active movement raises thresholds. Source:
/// docs/perception.md, "Two published curves".
#pragma once

#include <array>
#include <string_view>

namespace touchtrial::engine {

enum class ThresholdCurve {
  israr_2006,  ///< Israr, Choi and Tan 2006: a stylus; the more sensitive one
  tan_1994,    ///< Tan, Srinivasan, Eberman and Cheng 1994, after Bolanowski: the conservative one
};
inline constexpr std::array kThresholdCurves{ThresholdCurve::israr_2006, ThresholdCurve::tan_1994};
[[nodiscard]] std::string_view name_of(ThresholdCurve curve) noexcept;

/// The detection threshold of a vibration, measured by a three-interval one-up three-down
/// staircase. Interpolates linearly on logarithmic axes between the published frequencies. Constant
/// below the lowest (10 or 30 Hz) and above the highest (500 or 300 Hz).
/// \param frequency_hz  > 0
/// \return m, peak of a sine
[[nodiscard]] double threshold_displacement_m(ThresholdCurve curve, double frequency_hz) noexcept;

}  // namespace touchtrial::engine

/// \file Published thresholds for vibrations of a held stylus. They were measured on other people,
/// with steady vibrations of a hand at rest: active movement raises thresholds. Source:
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

/// The detection threshold of a vibration, by a three-interval one-up three-down track.
/// Straight lines on logarithmic axes between the published frequencies; below the lowest one (10
/// and 30 Hz) and above the highest one (500 and 300 Hz) the displacement stays.
/// \param frequency_hz  > 0
/// \return m, peak of a sine
[[nodiscard]] double threshold_displacement_m(ThresholdCurve curve, double frequency_hz) noexcept;

}  // namespace touchtrial::engine

/// \file What a stimulus will feel like, in figures. Source: docs/method.md, "Rendering".
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <array>

namespace touchtrial::engine {

/// The speeds for which FieldStatistics foretells vibration.
inline constexpr std::array<double, 3> kStrokeSpeedsMmPerS = {50.0, 100.0, 200.0};

/// Figures of one field with its gains, before the norm limit. Those of `surface` are stated at a
/// load of kStatedLoadN, because its lateral force grows with the load; its normal rms is that at a
/// constant depth.
struct FieldStatistics {
  double tangential_rms_n = 0.0;        ///< of |F_T| over all pixels
  double tangential_p999_n = 0.0;       ///< 99.9th percentile of |F_T| over all pixels
  double normal_rms_n = 0.0;            ///< of c * (G - 128), or of k * alpha * h
  double stiffness_p99_n_per_mm = 0.0;  ///< 99th percentile of the in-plane Jacobian's norm
  double share_below_1_mm = 0.0;        ///< share of tangential force power at wavelengths < 1 mm
  /// Share of tangential force power above 250 Hz for strokes at kStrokeSpeedsMmPerS. A wave is
  /// taken to be crossed at a right angle, where it is felt at the highest frequency it can be.
  std::array<double, 3> share_above_250_hz{};
};

/// Power is that of the variation: the mean force is left out.
/// \param options  of the study: `surface` goes by their stiffness, `paper` by none of them
/// \throws std::invalid_argument if the field is empty or has samples that are not finite
/// Thread-safe. Cost: two real FFTs of the field's size.
[[nodiscard]] FieldStatistics field_statistics(FieldView field, Gains gains,
                                               const RenderingOptions& options = {});

}  // namespace touchtrial::engine

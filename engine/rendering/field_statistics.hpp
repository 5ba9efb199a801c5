/// \file The lateral force of a field, and statistics that predict how a stimulus feels. Source:
/// docs/method.md, "Rendering".
#pragma once

#include "engine/force_field.hpp"
#include "engine/rendering/texture_field.hpp"

#include <array>

namespace touchtrial::engine {

/// The lateral force of a field at its pixel centres, before the norm limit.
struct LateralField {
  ForceField<double> force;  ///< grey levels per pixel, from bright to dark
  double n_per_grey = 0.0;   ///< newtons per (grey level per pixel)
};

/// `paper`: tangential_force() of the heights. `surface`: minus the gradient of the spline, with
/// newtons at a load of kReferenceLoadN. Thread-safe.
/// \throws std::invalid_argument if the field is empty
[[nodiscard]] LateralField lateral_field(FieldView field, Gains gains);

/// Stroke speeds for which FieldStatistics predicts vibration.
inline constexpr std::array<double, 3> kStrokeSpeedsMmPerS = {50.0, 100.0, 200.0};

/// Statistics of one field with its gains, before the norm limit. For `surface`, lateral statistics
/// hold at a load of kReferenceLoadN, because the force grows with the load, and the normal rms
/// holds at a constant depth.
struct FieldStatistics {
  double tangential_rms_n = 0.0;   ///< of |F_T| over all pixels
  double tangential_p999_n = 0.0;  ///< 99.9th percentile of |F_T| over all pixels
  double normal_rms_n = 0.0;       ///< of c * (G - 128), or of k * alpha * h
  /// 99th percentile of the in-plane Jacobian's norm; with a touchdown ramp, of the lateral force's
  /// Jacobian including depth, where it is largest.
  double stiffness_p99_n_per_mm = 0.0;
  double share_below_1_mm = 0.0;  ///< share of tangential force power at wavelengths < 1 mm
  /// Share of tangential force power above 250 Hz for strokes at kStrokeSpeedsMmPerS. Assumes
  /// strokes perpendicular to each wave, which give the highest frequency.
  std::array<double, 3> share_above_250_hz{};
};

/// Power excludes the mean force. Thread-safe. Cost: two real Fourier transforms of the field's
/// size.
/// \param options  of the study: `surface` uses the stiffness, `paper` stiffness and touchdown ramp
/// \throws std::invalid_argument if the field is empty or has non-finite samples
[[nodiscard]] FieldStatistics field_statistics(FieldView field, Gains gains,
                                               const RenderingOptions& options = {});

}  // namespace touchtrial::engine

/// \file The cubic B-spline through the samples of a plane: twice continuously differentiable,
/// with the plane mirrored at its edges.
/// Source: docs/method.md, "Rendering" (Unser, Aldroubi and Eden 1993).
#pragma once

#include "core/plane.hpp"
#include "engine/rendering/patch.hpp"

#include <span>

namespace touchtrial::engine {

/// Coefficients of the spline that interpolates the samples at their pixel centres, with
/// half-sample symmetric extension. Uses recursive filtering, exact to double rounding; a constant
/// plane is its own coefficients. Thread-safe. Cost: about 5 ns per pixel.
/// \param samples  at least 1 x 1, finite, any unit
[[nodiscard]] Plane<double> cubic_spline_coefficients(Plane<double> samples);

/// The spline's value and its gradient at a point in continuous pixel coordinates (pixel centres
/// are whole numbers), mirrored beyond the edges. Reads 16 coefficients. After the first call of
/// spline_sum() it neither allocates nor locks.
/// \param coefficients  row-major, height_px x width_px, each >= 1
/// \param x_px,y_px  not NaN; clamped to a magnitude of 2^29
/// \throws Error as spline_sum
[[nodiscard]] PatchSums spline_at(std::span<const float> coefficients, int height_px, int width_px,
                                  double x_px, double y_px);

}  // namespace touchtrial::engine

/// \file The cubic B-spline through the samples of a plane: twice continuously differentiable,
/// with the plane mirrored at its edges.
/// Source: docs/method.md, "Rendering" (Unser, Aldroubi and Eden 1993).
#pragma once

#include "core/plane.hpp"
#include "engine/rendering/patch.hpp"

#include <span>

namespace touchtrial::engine {

/// Coefficients of the spline that takes each sample's value at its pixel centre, under half-sample
/// symmetric extension. Recursive filtering, exact to double rounding; the coefficients of a
/// constant plane are the plane itself. Thread-safe. Cost: some 5 ns a pixel.
/// \param samples  at least 1 x 1, finite, any unit
[[nodiscard]] Plane<double> cubic_spline_coefficients(Plane<double> samples);

/// The spline's value and its gradient at a point in continuous pixel coordinates (pixel centres
/// are whole numbers), mirrored beyond the edges. Reads 16 coefficients. Neither allocates nor
/// locks once spline_sum has been called.
/// \param coefficients  row-major, height_px x width_px, each >= 1
/// \param x_px,y_px  not NaN; beyond the outer pixels clamped to a magnitude of 2^29
/// \throws Error as spline_sum
[[nodiscard]] PatchSums spline_at(std::span<const float> coefficients, int height_px, int width_px,
                                  double x_px, double y_px);

}  // namespace touchtrial::engine

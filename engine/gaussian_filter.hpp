/// \file The Gaussian: takes from a surface what no device could render, and from an image what is
/// texture. Source: docs/method.md, "Rendering" and "Other extractors".
#pragma once

#include "core/plane.hpp"

namespace touchtrial {

/// Convolves a plane with a sampled Gaussian of sum 1, mirrored at the edges (half-sample symmetric
/// extension, however far the kernel reaches out). Weights below 1e-12 of the middle one are left
/// out; otherwise exact to double rounding. Flat areas keep their exact value, and the plane keeps
/// its mean. Thread-safe. Cost: about 30 * sigma_px multiplications a pixel.
/// \param plane  at least 1 x 1, any unit
/// \param sigma_px  standard deviation, >= 0; 0 gives the plane itself, infinity its mean
/// \throws std::invalid_argument if the plane is empty or not finite, or sigma_px negative or NaN
[[nodiscard]] Plane<double> gaussian_filtered(const Plane<double>& plane, double sigma_px);

}  // namespace touchtrial

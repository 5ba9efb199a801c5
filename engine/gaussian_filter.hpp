/// \file The Gaussian filter. It removes surface detail too fine to render, and separates the
/// texture of an image. Source: docs/method.md, "Rendering" and "Other extractors".
#pragma once

#include "core/plane.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// Filters a plane row by row with memory for two rows and the weights. Sample is double or
/// std::uint8_t. The results equal gaussian_filtered() to the last bit. Keeps a reference to the
/// plane. Not thread-safe.
template <typename Sample>
class GaussianRows {
 public:
  /// \param plane  not empty
  /// \param sigma_px  > 0, may be infinite
  GaussianRows(const Plane<Sample>& plane, double sigma_px);

  /// Row y of the filtered plane; valid until the next call.
  [[nodiscard]] std::span<const double> row(int y);

 private:
  void filter_along_y(int y);
  void filter_along_x();

  const Plane<Sample>& plane_;
  std::vector<double> weights_y_;
  std::vector<double> weights_x_;
  std::vector<double> extended_;  ///< one row, filtered along y and mirrored at both ends
  std::vector<double> filtered_;
};

/// Convolves a plane with a sampled Gaussian of sum 1, with half-sample symmetric extension at the
/// edges. Omits weights below 1e-12 of the central weight; otherwise exact to double rounding. Flat
/// areas keep their exact value, and the plane keeps its mean. Thread-safe.
/// Cost: about 30 * sigma_px multiplications per pixel.
/// \param plane  at least 1 x 1, any unit
/// \param sigma_px  standard deviation, >= 0; 0 gives the plane itself, infinity its mean
/// \throws std::invalid_argument if the plane is empty or not finite, or sigma_px negative or NaN
[[nodiscard]] Plane<double> gaussian_filtered(const Plane<double>& plane, double sigma_px);

}  // namespace touchtrial::engine

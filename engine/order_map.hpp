/// \file The adaptive part of the method: computes the gradient of an image from its sub-bands, and
/// from that the order of differentiation at each pixel.
/// Source: docs/method.md, "Gradient and order map" and "Options" (paper Eqs. 2-4).
#pragma once

#include "core/plane.hpp"
#include "engine/daub4.hpp"
#include "engine/extraction_options.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// Computes the norm of a plane's gradient row by row, with symmetric extension. It takes
/// differences before sums, so that equal neighbours give exactly 0. Sample is double or
/// std::uint8_t. Keeps a reference to the plane. Not thread-safe.
template <typename Sample>
class GradientRows {
 public:
  /// \param plane  not empty
  GradientRows(const Plane<Sample>& plane, Gradient gradient);

  /// The norms of row y, >= 0; valid until the next call.
  [[nodiscard]] std::span<const double> row(int y);

 private:
  [[nodiscard]] double& smooth(int x) { return smooth_[static_cast<std::size_t>(x + 1)]; }
  [[nodiscard]] double& slope(int x) { return slope_[static_cast<std::size_t>(x + 1)]; }
  void filter_columns(int y);

  const Plane<Sample>& plane_;
  Gradient gradient_;
  std::vector<double> smooth_;  ///< along y, with one mirrored sample at both ends
  std::vector<double> slope_;
  std::vector<double> norms_;
};

/// The composite sub-band gradient (CSGV), a measure of local steepness in all sub-bands. Combines
/// the gradient norms of the last level's ll and of every level's details at the resolution of the
/// first level, where sample (y, x) covers the image's samples (2y, 2x) to (2y+1, 2x+1). Norms of
/// deeper levels are enlarged by repetition.
/// \param levels  at least one; each computed from the ll of the previous level; no empty planes
/// \return >= 0, exactly 0 everywhere for a flat image
/// Thread-safe.
[[nodiscard]] Plane<double> composite_gradient(std::span<const SubBands> levels, Gradient gradient,
                                               Combine combine);

/// The same with the method's defaults: one level, Sobel, the sum.
[[nodiscard]] Plane<double> composite_gradient(const SubBands& bands);

/// The thresholds between the three branches of the order map; both belong to the middle branch.
inline constexpr double kFlatBelowCsgv = 2.0;
inline constexpr double kSteepAboveCsgv = 128.0;

/// The order map: 0 below 2; CSGV / (3M) + 0.666 from 2 to 128; CSGV / (2M) + 0.499 above. M is the
/// largest CSGV.
/// \param csgv  >= 0 everywhere, not empty
/// \return orders, dimensionless, in [0, 1), of the same shape
/// Thread-safe.
[[nodiscard]] Plane<double> order_map(const Plane<double>& csgv);

/// Enlarges a half-resolution plane by repetition: sample (y, x) is half(y / 2, x / 2), rounded
/// down.
/// \param half  ceil(height/2) x ceil(width/2) samples
/// \param height,width  of the image, pixels
template <typename Real>
[[nodiscard]] Plane<Real> doubled(const Plane<double>& half, int height, int width);

}  // namespace touchtrial::engine

/// \file The objective of TV-Gabor, J(u) + (lambda / 2) <f - u, K (f - u)> over u on a torus, with
/// the operator M = K^-1 and the gradient on the torus. Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial::engine {

/// Samples of the torus before the image on each axis; at least as many follow it.
inline constexpr int kTorusMargin = 16;

/// The smallest even length >= n + 2 * kTorusMargin without prime factors above 7, for a fast FFT
/// (500 -> 540).
/// \param n  length of an image axis, >= 1
[[nodiscard]] int torus_length(int n);

/// Extends the image by mirrored margins to torus_length on each axis, kTorusMargin samples before
/// it.
template <typename Real>
[[nodiscard]] Plane<Real> extended_to_torus(const GreyImage& image);

/// The spectrum of M, which defines the oscillations of texture: the sum of |g^|^2 over the
/// components, scaled to a maximum of 1, where g is an 11 x 11 even Gabor patch of standard
/// deviation 2 px minus its mean. Non-negative by construction, and zero at frequency zero.
/// \param components  at least one, each with a frequency in (0, 0.5] and a finite direction
/// \param height,width  of the torus, >= 11
/// \return height x (width / 2 + 1), in the layout of RealFft's spectrum
[[nodiscard]] Plane<double> gabor_spectrum(std::span<const GaborComponent> components, int height,
                                           int width);

template <typename Real>
struct TvGaborProblem {
  Plane<Real> image;          ///< f, grey levels
  std::vector<Real> factors;  ///< the spectrum of M, in [0, 1], in the layout of arranged_factors()
  double lambda;              ///< weight of the texture norm
};

/// \param image  at least 1 x 1
/// \param options  with explicit components
template <typename Real>
[[nodiscard]] TvGaborProblem<Real> tv_gabor_problem(const GreyImage& image,
                                                    const TvGaborOptions& options);

/// The mean of |grad f|, grey levels per pixel; > 0 unless the image is flat.
template <typename Real>
[[nodiscard]] double mean_gradient(const Plane<Real>& torus);

/// A vector at each sample of the torus: components along x and y.
template <typename Real>
struct VectorField {
  VectorField(int height, int width) : x(height, width), y(height, width) {}

  Plane<Real> x;
  Plane<Real> y;
};

/// The gradient of one row by forward differences to the right neighbour (cyclic) and to the row
/// below. All spans have the width of the torus, at least 1.
template <typename Real>
void gradient_of_row(std::span<const Real> row, std::span<const Real> row_below,
                     std::span<Real> along_x, std::span<Real> along_y) noexcept {
  const std::size_t last_x = row.size() - 1;
  for (std::size_t x = 0; x < last_x; ++x) along_x[x] = row[x + 1] - row[x];
  along_x[last_x] = row[0] - row[last_x];
  for (std::size_t x = 0; x <= last_x; ++x) along_y[x] = row_below[x] - row[x];
}

}  // namespace touchtrial::engine

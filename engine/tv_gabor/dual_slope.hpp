/// \file The slope of TV-Gabor's dual, which the slower solvers follow.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/vector_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// Steps of the projected gradient up to this length converge: |grad M div| <= 8.
inline constexpr double kLongestDualStep = 0.125;

template <typename Real>
class DualSlope {
 public:
  /// Keeps references to both; the transform has the image's size.
  DualSlope(const TvGaborProblem<Real>& problem, RealFft<Real>& fft);

  /// Gets ready to give the rows of w = grad(M div p - lambda f). \param q  -p
  void at(const VectorField<Real>& q);
  /// w, of one row of the torus; valid until the next call.
  void go_to_row(int y);
  [[nodiscard]] std::span<const Real> x() const noexcept { return x_; }
  [[nodiscard]] std::span<const Real> y() const noexcept { return y_; }

 private:
  const TvGaborProblem<Real>& problem_;
  RealFft<Real>& fft_;
  std::vector<Real> x_, y_;
};

}  // namespace touchtrial::engine

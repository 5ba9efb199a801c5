/// \file Accelerated projected gradient for TV-Gabor's dual, kept as a reference.
/// Source: A. Beck and M. Teboulle, "A fast iterative shrinkage-thresholding algorithm for linear
/// inverse problems", 2009; docs/method.md, "TV-Gabor".
#pragma once

#include "engine/tv_gabor/dual_slope.hpp"
#include "engine/tv_gabor/vector_field.hpp"

#include <vector>

namespace touchtrial::engine {

/// Steps of 1/8 from p = 0.
template <typename Real>
class TvGaborFista {
 public:
  /// Keeps references to both; the transform is also used by others between steps.
  TvGaborFista(const TvGaborProblem<Real>& problem, RealFft<Real>& fft);

  void step();
  /// q = -p, at most 1 long.
  [[nodiscard]] const VectorField<Real>& q() const noexcept { return q_; }

 private:
  DualSlope<Real> slope_;
  VectorField<Real> q_;
  VectorField<Real> ahead_;            // where the slope is taken
  std::vector<Real> next_x_, next_y_;  // rows
  double t_ = 1.0;
};

}  // namespace touchtrial::engine

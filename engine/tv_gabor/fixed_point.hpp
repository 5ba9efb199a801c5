/// \file The semi-implicit fixed point for TV-Gabor's dual, kept as the baseline to beat.
/// Source: A. Chambolle, "An algorithm for total variation minimization and applications", 2004;
/// docs/method.md, "TV-Gabor".
#pragma once

#include "engine/tv_gabor/dual_slope.hpp"
#include "engine/tv_gabor/vector_field.hpp"

#include <vector>

namespace touchtrial::engine {

/// p <- (p + tau w) / (1 + tau |w|), with tau = 1/8, from p = 0.
template <typename Real>
class TvGaborFixedPoint {
 public:
  /// Keeps references to both; the transform is also used by others between steps.
  TvGaborFixedPoint(const TvGaborProblem<Real>& problem, RealFft<Real>& fft);

  void step();
  /// q = -p, at most 1 long.
  [[nodiscard]] const VectorField<Real>& q() const noexcept { return q_; }

 private:
  DualSlope<Real> slope_;
  VectorField<Real> q_;
  std::vector<Real> norms_;  // of a row
};

}  // namespace touchtrial::engine

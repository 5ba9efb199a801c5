/// \file What a feasible dual point proves: its texture, and the largest distance from the optimum.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/problem.hpp"

namespace touchtrial::engine {

template <typename Real>
struct TvGaborCertificate {
  Plane<Real> texture;  ///< v = M div p / lambda on the torus, grey levels
  double gap = 0.0;     ///< (primal - dual) / primal, >= 0; 0 where the primal value is 0
};

/// \param field,scale  the dual point: p = -scale * field, its vectors shortened to 1 if longer
/// \param fft  of the problem's size; its buffers are overwritten
template <typename Real>
[[nodiscard]] TvGaborCertificate<Real> certify(const TvGaborProblem<Real>& problem,
                                               const VectorField<Real>& field, double scale,
                                               RealFft<Real>& fft);

}  // namespace touchtrial::engine

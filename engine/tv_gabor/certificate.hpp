/// \file What a feasible dual point proves: its texture, and how far that can be from the best.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/vector_field.hpp"

namespace touchtrial::engine {

template <typename Real>
struct TvGaborCertificate {
  Plane<Real> texture;  ///< v = M div p / lambda on the torus, grey levels
  double gap = 0.0;     ///< (primal - dual) / primal, >= 0; 0 where the primal value is 0
};

/// \param field,scale  the dual point: p = -scale * field, where longer than 1 shortened to that
/// \param fft  of the problem's size; what its buffers hold is lost
template <typename Real>
[[nodiscard]] TvGaborCertificate<Real> certify(const TvGaborProblem<Real>& problem,
                                               const VectorField<Real>& field, double scale,
                                               RealFft<Real>& fft);

}  // namespace touchtrial::engine

/// \file The fast TV-Gabor solver: over-relaxed ADMM on w = grad u = grad f - grad v.
/// Source: docs/method.md, "TV-Gabor"; residuals after B. Wohlberg, "ADMM penalty parameter
/// selection by residual balancing", 2017.
#pragma once

#include "core/plane.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/vector_field.hpp"

#include <span>
#include <vector>

namespace touchtrial {

/// How far a step was from the fixed point, each relative to the size of what should agree. The
/// image's gradient is among the sizes: a cartoon that becomes flat leaves nothing else to compare
/// with.
struct AdmmResiduals {
  double primal = 0.0;  ///< |grad u - w| / max(|grad u|, |w|, |grad f|)
  double dual = 0.0;    ///< |change of w| / |b|
};

/// The iteration's state: w, which becomes the cartoon's gradient, and the scaled multiplier b,
/// for which |b| <= 1 / penalty holds at every pixel after every step. Works on the texture v and
/// not on the cartoon u: the image enters by its gradient alone, which is exact, so that rounding
/// is relative to the texture and not to the image's 255 grey levels. (Float needs that: an error
/// of u reaches v multiplied by penalty / lambda, about 100.)
template <typename Real>
class TvGaborAdmm {
 public:
  /// Starts at w = b = 0. Keeps references to both arguments; the transform has the image's size
  /// and is also used by others between steps.
  /// \param penalty  rho, 1 / grey levels, > 0
  TvGaborAdmm(const TvGaborProblem<Real>& problem, RealFft<Real>& fft, double penalty);

  void step();
  /// The same step, with its residuals.
  [[nodiscard]] AdmmResiduals measured_step();

  /// Multiplies the penalty, keeping w and the unscaled multiplier.
  void scale_penalty(double factor);

  /// Takes over w, b and the penalty of an iteration on the same image in another precision.
  template <typename Other>
  void resume(const TvGaborAdmm<Other>& former) {
    penalty_ = former.penalty();
    multiplier_.x = converted<Real>(former.scaled_multiplier().x);
    multiplier_.y = converted<Real>(former.scaled_multiplier().y);
    target_.x = converted<Real>(former.target().x);
    target_.y = converted<Real>(former.target().y);
  }

  [[nodiscard]] double penalty() const noexcept { return penalty_; }
  [[nodiscard]] const VectorField<Real>& scaled_multiplier() const noexcept { return multiplier_; }
  /// grad f - w + b, what grad v should be.
  [[nodiscard]] const VectorField<Real>& target() const noexcept { return target_; }

 private:
  struct Sums;

  void update_texture();
  void update_row(int y);
  void add_residuals(int y, Sums& sums) const;
  [[nodiscard]] int row_below(int y) const noexcept;
  [[nodiscard]] std::span<const Real> texture_row(int y) const;

  const TvGaborProblem<Real>& problem_;
  RealFft<Real>& fft_;
  double penalty_;
  std::vector<Real> laplacian_y_, laplacian_x_;  // |grad^|^2 is their sum
  VectorField<Real> multiplier_;                 // b
  VectorField<Real> target_;
  VectorField<Real> image_, texture_, w_;  // grad f, grad v, w before the step; of one row
};

}  // namespace touchtrial

/// \file The fast TV-Gabor solver: over-relaxed ADMM on w = grad u = grad f - grad v, with a little
/// momentum. Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/vector_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// How eagerly an iteration moves. Each holds alone what it gained; with momentum the relaxation
/// has to be smaller.
enum class AdmmPace { cautious, eager };

/// How far a step was from the fixed point: the changes of the scaled multiplier and of w, each
/// relative to the size of what it should agree with. The image's gradient is among the sizes: a
/// cartoon that becomes flat leaves nothing else to compare with. After B. Wohlberg, "ADMM penalty
/// parameter selection by residual balancing", 2017.
struct AdmmResiduals {
  double primal = 0.0;  ///< |change of b| / max(|w|, |grad f|)
  double dual = 0.0;    ///< |change of w| / |b|
};

/// The iteration's state is one field, z = w + b: the multiplier b, scaled, is z with its vectors
/// shortened to 1 / penalty, and w, which becomes the cartoon's gradient, is the rest. Works on the
/// texture v and not on the cartoon u: the image enters by its gradient alone, which is exact, so
/// that rounding is relative to the texture and not to the image's 255 grey levels. (Float needs
/// that: an error of u reaches v multiplied by penalty / lambda, about 100.)
/// A step reads and writes each plane once beside its two transforms. Takes 30 bytes a sample of
/// the torus in float with problem and transform, 60 in double.
template <typename Real>
class TvGaborAdmm {
 public:
  /// Starts at z = grad f / 2. Keeps references to both arguments; the transform has the image's
  /// size and is also used by others between steps, see start_again().
  /// \param penalty  rho, 1 / grey levels, > 0
  TvGaborAdmm(const TvGaborProblem<Real>& problem, RealFft<Real>& fft, double penalty);

  /// start_again() comes before the first step, and before any step after which others used the
  /// transform, or the penalty or z changed. It forgets the momentum.
  void start_again();
  void step(AdmmPace pace);
  /// A step without momentum, with its residuals.
  [[nodiscard]] AdmmResiduals measured_step();

  /// Changes the penalty, keeping w and the unscaled multiplier.
  void set_penalty(double penalty);

  /// Takes over an iteration on the same image in another precision.
  template <typename Other>
  void resume(const VectorField<Other>& z, double penalty) {
    penalty_ = penalty;
    z_.x = converted<Real>(z.x);
    z_.y = converted<Real>(z.y);
  }

  [[nodiscard]] double penalty() const noexcept { return penalty_; }
  /// penalty() * z, shortened to 1 where it is longer, is minus a dual point.
  [[nodiscard]] const VectorField<Real>& z() const noexcept { return z_; }

 private:
  template <typename Around>
  void map(double relaxation, double momentum, const Around& around);
  void filter();
  template <typename TargetRow>
  void load_targets(const TargetRow& target_row);
  [[nodiscard]] int row_below(int y) const noexcept;
  [[nodiscard]] std::span<Real> plane_row(int y) const;

  const TvGaborProblem<Real>& problem_;
  RealFft<Real>& fft_;
  double penalty_;
  std::vector<Real> laplacian_y_, laplacian_x_;  // |grad^|^2 is their sum
  VectorField<Real> z_;
  VectorField<Real> former_;  // the map's last value
  bool has_former_ = false;
  double image_squared_ = 0.0;                             // sum of |grad f|^2
  std::vector<Real> target_x_, target_y_, above_, first_;  // rows
};

}  // namespace touchtrial::engine

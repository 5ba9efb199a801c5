/// \file The fast TV-Gabor solver: over-relaxed ADMM on w = grad u = grad f - grad v, with a little
/// momentum. Source: docs/method.md, "TV-Gabor".
/// Private to engine/tv_gabor.
#pragma once

#include "core/plane.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/row_kernels.hpp"
#include "engine/tv_gabor/torus_plane.hpp"

#include <vector>

namespace touchtrial::engine {

/// The pace of an iteration: cautious steps relax more, without momentum; eager ones relax less,
/// with momentum.
enum class AdmmPace { cautious, eager };

/// The distance of a step from the fixed point: the changes of the scaled multiplier and of w, each
/// relative to a reference size. The image's gradient is among the references, because a cartoon
/// that becomes flat leaves no other. After B. Wohlberg, "ADMM penalty parameter selection by
/// residual balancing", 2017.
struct AdmmResiduals {
  double primal = 0.0;  ///< |change of b| / max(|w|, |grad f|)
  double dual = 0.0;    ///< |change of w| / |b|
};

/// The iteration's state is one field, z = w + b: the scaled multiplier b is z with its vectors
/// shortened to 1 / penalty, and w, which becomes the cartoon's gradient, is the rest. The
/// iteration works on the texture v, not on the cartoon u: the image enters through its gradient
/// only, which is exact, so that rounding is relative to the texture and not to the image's 255
/// grey levels. (Float needs that: an error of u reaches v multiplied by penalty / lambda, about
/// 100.) A step is one pass over the columns of the half transformed texture, and one over rows,
/// which reads and writes each plane once. Memory with problem and transform: 28 bytes a sample of
/// the torus in float, 56 in double.
template <typename Real>
class TvGaborAdmm {
 public:
  /// Starts at z = grad f / 2. Keeps references to problem and plane; others may use the plane
  /// between steps, see start_again().
  /// \param plane  of the problem's size
  TvGaborAdmm(const TvGaborProblem<Real>& problem, TorusPlane<Real>& plane);

  /// Call this before the first step, and again before a step if others have used the plane, or z
  /// has changed. Forgets the momentum. If the penalty changes, w and the unscaled multiplier stay.
  /// \param penalty  rho, 1 / grey levels, > 0
  void start_again(double penalty);
  void step(AdmmPace pace);
  /// A step without momentum, after which the plane holds -div b for a certificate: start again.
  void last_step();
  /// The same, with residuals.
  [[nodiscard]] AdmmResiduals measured_last_step();

  /// Continues an iteration on the same image from another precision, where z() and penalty() were
  /// these.
  template <typename Other>
  void resume(const VectorField<Other>& z, double penalty) {
    penalty_ = penalty;
    z_.x = converted<Real>(z.x);
    z_.y = converted<Real>(z.y);
  }

  [[nodiscard]] double penalty() const noexcept { return penalty_; }
  /// Minus a dual point is penalty() * z, with vectors longer than 1 shortened to 1.
  [[nodiscard]] const VectorField<Real>& z() const noexcept { return z_; }

 private:
  template <typename Watch>
  typename Watch::Sums map(AdmmPace pace, bool is_last);
  void set_factors();
  [[nodiscard]] int row_below(int y) const noexcept;
  [[nodiscard]] AdmmRow<Real> row_of(int y) noexcept;

  const TvGaborProblem<Real>& problem_;
  TorusPlane<Real>& plane_;
  double penalty_ = 0.0;                         // none yet
  std::vector<Real> laplacian_y_, laplacian_x_;  // |grad^|^2 is their sum
  std::vector<Real> factors_;                    // of a step's filter
  VectorField<Real> z_;
  VectorField<Real> former_;  // the map's last value
  bool has_former_ = false;
};

}  // namespace touchtrial::engine

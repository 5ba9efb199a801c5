/// \file The TV-Gabor iteration: over-relaxed ADMM on w = grad u = grad f - grad v, with momentum.
/// Source: docs/method.md, "TV-Gabor".
/// Private to engine/tv_gabor.
#pragma once

#include "core/plane.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/row_kernels.hpp"
#include "engine/tv_gabor/torus_plane.hpp"

#include <vector>

namespace touchtrial::engine {

/// The pace of an iteration: cautious steps over-relax more, without momentum; eager steps
/// over-relax less, with momentum.
enum class AdmmPace { cautious, eager };

/// The residuals of a step: the changes of the scaled multiplier and of w, relative to reference
/// norms. The image's gradient is one reference, because a cartoon may become flat. After B.
/// Wohlberg, "ADMM penalty parameter selection by residual balancing", 2017.
struct AdmmResiduals {
  double primal = 0.0;  ///< |change of b| / max(|w|, |grad f|)
  double dual = 0.0;    ///< |change of w| / |b|
};

/// The state of the iteration is a field z = w + b. The scaled multiplier b is z with vectors
/// clipped to 1 / penalty, and w = z - b converges to the cartoon's gradient. The iteration uses
/// the texture v, not the cartoon u, and only the exact gradient of the image, so that rounding is
/// relative to the texture and not to 255 grey levels. (In float, an error of u would enter v
/// multiplied by penalty / lambda, about 100.) A step is one pass over the columns of the
/// transformed texture and one pass over rows, which reads and writes each plane once. Memory with
/// problem and transform: 28 bytes per sample of the torus in float, 56 in double.
template <typename Real>
class TvGaborAdmm {
 public:
  /// Starts at z = grad f / 2. Keeps references to problem and plane; other code may use the plane
  /// between steps, see restart().
  /// \param plane  of the problem's size
  TvGaborAdmm(const TvGaborProblem<Real>& problem, TorusPlane<Real>& plane);

  /// Call before the first step, and after other code has used the plane or changed z. Resets the
  /// momentum. Keeps w and the unscaled multiplier if the penalty changes.
  /// \param penalty  rho, 1 / grey levels, > 0
  void restart(double penalty);
  void step(AdmmPace pace);
  /// A step without momentum that leaves -div b in the plane, for a certificate; then call
  /// restart().
  void final_step();
  /// Takes the same step and returns its residuals.
  [[nodiscard]] AdmmResiduals measured_final_step();

  /// Continues an iteration on the same image from the state of another precision.
  template <typename Other>
  void resume(const VectorField<Other>& z, double penalty) {
    penalty_ = penalty;
    z_.x = converted<Real>(z.x);
    z_.y = converted<Real>(z.y);
  }

  [[nodiscard]] double penalty() const noexcept { return penalty_; }
  /// penalty() * z with vectors clipped to 1 is minus a dual point.
  [[nodiscard]] const VectorField<Real>& z() const noexcept { return z_; }

 private:
  template <typename Observer>
  typename Observer::Sums apply_map(AdmmPace pace, bool is_last);
  void set_factors();
  [[nodiscard]] int row_below(int y) const noexcept;
  [[nodiscard]] AdmmRow<Real> row_of(int y) noexcept;

  const TvGaborProblem<Real>& problem_;
  TorusPlane<Real>& plane_;
  double penalty_ = 0.0;                         // 0 before restart()
  std::vector<Real> laplacian_y_, laplacian_x_;  // |grad^|^2 is their sum
  std::vector<Real> factors_;                    // of a step's filter
  VectorField<Real> z_;
  VectorField<Real> previous_map_;  // previous value of the map
  bool has_previous_ = false;
};

}  // namespace touchtrial::engine

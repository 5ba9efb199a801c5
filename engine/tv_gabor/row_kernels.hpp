/// \file The TV-Gabor solvers' kernels for one row, on the best instruction set of the machine.
/// Real is float or double. Pointers of one call must not overlap unless stated otherwise.
#pragma once

#include <cstddef>

namespace touchtrial::engine {

/// One row of the ADMM map; see TvGaborAdmm. Each pointer leads to `width` samples; `image_below`
/// and `texture_below` are the next row on the torus.
template <typename Real>
struct AdmmRow {
  const Real* image;
  const Real* image_below;
  const Real* texture;
  const Real* texture_below;
  Real* z_x;  ///< in and out
  Real* z_y;
  Real* former_x;  ///< the map's previous value, in if there is momentum, out if it is kept
  Real* former_y;
  Real* target_x;  ///< out: grad f - z + 2 b, or b alone, with b = clip(z)
  Real* target_y;
};

template <typename Real>
struct AdmmNumbers {
  Real relaxation;
  Real limit;        ///< of |b|, 1 / penalty
  Real momentum;     ///< share of the last change to add again
  bool keep_former;  ///< for the next step's momentum
  bool b_alone;      ///< as target
};

template <typename Real>
struct RestartNumbers {
  Real former_limit;  ///< of |b| until now
  Real limit;         ///< from now on
};

/// One row of a certificate; see certify. `image_below` and `texture_below` are the next row on the
/// torus.
template <typename Real>
struct GapRow {
  const Real* image;
  const Real* image_below;
  const Real* texture;
  const Real* texture_below;
  const Real* q_x;
  const Real* q_y;
};

/// Sums over samples, in double.
struct GapSums {
  double primal = 0.0;      ///< |grad u| + <q, grad v> / 2, with u = f - v
  double difference = 0.0;  ///< |grad u| - <q, grad u>, 0 where rounding makes it negative

  GapSums& operator+=(const GapSums& other) noexcept {
    primal += other.primal;
    difference += other.difference;
    return *this;
  }
};

template <typename Real>
struct RowKernels {
  void (*admm)(const AdmmRow<Real>& row, std::size_t width, const AdmmNumbers<Real>& numbers);
  /// Rescales b, and with it z, from one limit to another, keeping w, and writes the targets of a
  /// row; texture and former are not read.
  void (*restart)(const AdmmRow<Real>& row, std::size_t width, const RestartNumbers<Real>& numbers);
  /// out = -div of a row of a field on the torus: the adjoint of the gradient.
  /// \param above  y of the row above
  void (*divergence)(const Real* x, const Real* y, const Real* above, std::size_t width, Real* out);
  /// out = the point with norm <= 1 nearest to scale * (x, y). The outputs may be the inputs.
  void (*clip)(const Real* x, const Real* y, std::size_t width, Real scale, Real* out_x,
               Real* out_y);
  GapSums (*gap)(const GapRow<Real>& row, std::size_t width);
};

template <typename Real>
[[nodiscard]] RowKernels<Real> row_kernels();

}  // namespace touchtrial::engine

/// \file The row kernels of the TV-Gabor solvers, vectorised for every target.
/// Real is float or double. Pointers of one call must not overlap unless stated otherwise.
#pragma once

#include <cstddef>

namespace touchtrial::engine {

/// One row of the ADMM map; see TvGaborAdmm. Each pointer refers to `width` samples; `image_below`
/// and `texture_below` are the next row on the torus.
template <typename Real>
struct AdmmRow {
  const Real* image;
  const Real* image_below;
  const Real* texture;
  const Real* texture_below;
  Real* z_x;  ///< in and out
  Real* z_y;
  Real* previous_x;  ///< previous value of the map: input with momentum, output if store_previous
  Real* previous_y;
  Real* target_x;  ///< out: grad f - z + 2 b, or only b, with b = clip(z)
  Real* target_y;
};

template <typename Real>
struct AdmmNumbers {
  Real relaxation;
  Real limit;           ///< of |b|, 1 / penalty
  Real momentum;        ///< share of the last change to add
  bool store_previous;  ///< store the value for the next step's momentum
  bool b_only;          ///< write only b as target
};

template <typename Real>
struct RestartNumbers {
  Real previous_limit;  ///< previous limit of |b|
  Real limit;           ///< new limit of |b|
};

/// One row of a certificate; see certified_gap(). `image_below` and `texture_below` are the next
/// row on the torus.
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
  /// Rescales b from one limit to another and updates z, keeping w; writes the targets of a row.
  /// Ignores the texture and the previous value of the map.
  void (*restart)(const AdmmRow<Real>& row, std::size_t width, const RestartNumbers<Real>& numbers);
  /// out = -div of a row of a field on the torus: the adjoint of the gradient.
  /// \param y_above  y of the row above
  void (*divergence)(const Real* x, const Real* y, const Real* y_above, std::size_t width,
                     Real* out);
  /// out = the point with norm <= 1 nearest to scale * (x, y). The outputs may be the inputs.
  void (*clip)(const Real* x, const Real* y, std::size_t width, Real scale, Real* out_x,
               Real* out_y);
  GapSums (*gap)(const GapRow<Real>& row, std::size_t width);
};

template <typename Real>
[[nodiscard]] RowKernels<Real> row_kernels();

}  // namespace touchtrial::engine

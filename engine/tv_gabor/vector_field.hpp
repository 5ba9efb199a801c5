/// \file Gradient and divergence on a torus: forward differences and their negative adjoint.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"

#include <span>

namespace touchtrial::engine {

/// Two planes of one shape: components along columns and along rows.
template <typename Real>
struct VectorField {
  VectorField(int height, int width) : x(height, width), y(height, width) {}

  Plane<Real> x;
  Plane<Real> y;
};

/// The gradient of one row: to the right (the last sample wraps round) and to the row below.
/// All spans have the torus' width, at least 1.
template <typename Real>
void gradient_of_row(std::span<const Real> row, std::span<const Real> below,
                     std::span<Real> along_x, std::span<Real> along_y) noexcept {
  const std::size_t last = row.size() - 1;
  for (std::size_t x = 0; x < last; ++x) along_x[x] = row[x + 1] - row[x];
  along_x[last] = row[0] - row[last];
  for (std::size_t x = 0; x <= last; ++x) along_y[x] = below[x] - row[x];
}

/// out = -div field, one row: the adjoint of the gradient. \param above  along_y of the row above
template <typename Real>
void negative_divergence_of_row(std::span<const Real> along_x, std::span<const Real> along_y,
                                std::span<const Real> above, std::span<Real> out) noexcept {
  out[0] = (along_x.back() - along_x[0]) + (above[0] - along_y[0]);
  for (std::size_t x = 1; x < out.size(); ++x) {
    out[x] = (along_x[x - 1] - along_x[x]) + (above[x] - along_y[x]);
  }
}

}  // namespace touchtrial::engine

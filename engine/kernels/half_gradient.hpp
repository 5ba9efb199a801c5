/// \file The composite sub-band gradient (CSGV) of an image at half resolution and the resulting
/// orders, in single precision, vectorised for every target.
/// Source: docs/method.md, "Gradient and order map".
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/strips.hpp"

#include <cstddef>

namespace touchtrial::engine {

/// CSGV at half resolution, and its maximum. The orders need a second pass, because the maximum is
/// known only after the last row. Until then CSGV is stored in the scratch plane.
///
/// Computation up to the gradient uses exact integers. CSGV is exact where the gradient is an
/// integer along one axis, as for ramps, and 0 where there is no gradient.
class HalfGradient {
 public:
  /// \param image  not empty
  /// \param scratch  a plane of the image's shape, which is overwritten. Row y of CSGV in a tile
  ///   (for_each_tile) uses rows 2 y and 2 y + 1 of that tile, which may be overwritten after
  ///   reading row(y, tile). Must outlive this object.
  HalfGradient(const GreyImage& image, Plane<float>& scratch);

  /// CSGV of a tile of the image, rounded up to whole pairs of columns.
  [[nodiscard]] const float* row(int y, Columns tile) const noexcept { return row_start(y, tile); }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] float max_csgv() const noexcept { return max_csgv_; }

 private:
  [[nodiscard]] float* row_start(int y, Columns tile) const noexcept {
    return scratch_.row(2 * y).data() + tile.first;
  }
  /// \return the largest CSGV of these rows
  float compute(const GreyImage& image, Rows rows, Columns tile);

  Plane<float>& scratch_;
  int height_;
  int width_;
  float max_csgv_ = 0.0F;
};

/// Computes the orders of one row, each twice: out[2 i] = out[2 i + 1] = order of csgv[i].
/// \param largest  maximum over the image, >= kFlatBelowCsgv
/// \param out  receives 2 * count samples; two vectors after them may be overwritten
void order_row(const float* csgv, int count, float largest, float* out);

}  // namespace touchtrial::engine

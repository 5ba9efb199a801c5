/// \file The composite sub-band gradient (CSGV) of an image at half resolution, and the orders that
/// follow from it, in single precision, vectorised for every target.
/// Source: docs/method.md, "Gradient and order map".
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/strips.hpp"

#include <cstddef>

namespace touchtrial::engine {

/// CSGV at half resolution, and its maximum. As the maximum is known only after the last row, the
/// orders need a second pass. Until then CSGV waits in the plane that will receive the texture.
///
/// Everything up to the gradient is exact in whole numbers: CSGV is exact where the gradient is a
/// whole number along one axis, as for ramps, and 0 where there is no gradient.
class HalfGradient {
 public:
  /// \param image  not empty
  /// \param room  a plane of the image's shape, which is overwritten. Two rows of a tile of it
  ///   (for_each_tile) belong to each row of CSGV there, and nothing else is stored there: after
  ///   reading row(y, tile), rows 2 y and 2 y + 1 of the tile may be overwritten. Must outlive
  ///   this.
  HalfGradient(const GreyImage& image, Plane<float>& room);

  /// CSGV of a tile of the image, rounded up to whole pairs of columns.
  [[nodiscard]] const float* row(int y, Columns tile) const noexcept { return place(y, tile); }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] float largest() const noexcept { return largest_; }

 private:
  [[nodiscard]] float* place(int y, Columns tile) const noexcept {
    return room_.row(2 * y).data() + tile.first;
  }
  /// \return the largest CSGV of these rows
  float compute(const GreyImage& image, Rows rows, Columns tile);

  Plane<float>& room_;
  int height_;
  int width_;
  float largest_ = 0.0F;
};

/// The orders of one row, each twice: out[2 i] = out[2 i + 1] = the order of csgv[i].
/// \param largest  of the whole image, >= kFlatBelowCsgv
/// \param out  receives 2 * count samples; two vectors behind them may be overwritten
void order_row(const float* csgv, int count, float largest, float* out);

}  // namespace touchtrial::engine

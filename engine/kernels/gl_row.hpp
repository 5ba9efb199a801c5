/// \file Computes rows of Gruenwald-Letnikov texture in single precision from a window of image
/// rows, vectorised for every target.
///
/// W_k is the sum of three samples of a column: k above the row, in it, and k below it. Then
///   8 D_k(x) = 9 I(x) - W_k(x - k) - W_k(x) - W_k(x + k),
/// exactly in 16 bits, and T = v/8 (8 D_1 + a_2 (8 D_2 + a_3 (8 D_3 + ..))) with a_k = (k - 1 - v)
/// / k. That takes two fused operations per ring, and the error does not grow with K.
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/strips.hpp"

#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {

/// A sliding window of the rows y - reach .. y + reach of a tile of an image, as 16-bit integers.
/// Rows are extended by `reach` samples at both ends, mirrored at the image's edges. Converts every
/// row once and stores 2 * reach + 1 rows. Keeps a reference to the image. Not thread-safe.
class ExtendedRows {
 public:
  /// \param image  not empty
  /// \param reach  >= 1; may exceed the image
  /// \param first_row  the row of the image to which the first next_row() moves
  ExtendedRows(const GreyImage& image, int reach, int first_row = 0)
      : ExtendedRows(image, reach, first_row, {0, image.width()}) {}
  /// \param tile  columns of the image, at least one
  ExtendedRows(const GreyImage& image, int reach, int first_row, Columns tile);

  /// Moves to the next row, which must exist. The first call moves to `first_row`.
  void next_row();

  /// The tile's first sample of the row `offset` below the current row. Samples -reach .. width - 1
  /// + reach and one further vector may be read. Valid until next_row().
  /// \param offset  -reach .. reach
  [[nodiscard]] const std::int16_t* row(int offset) const noexcept {
    return rows_.row(slot(offset));
  }
  [[nodiscard]] int width() const noexcept { return tile_.count(); }

 private:
  /// Loads a row of the image into the slot of an offset.
  void load(int offset);
  /// The slot of the row at an offset; slots rotate with the current row.
  [[nodiscard]] std::size_t slot(int offset) const noexcept {
    const int index = current_ + offset;
    const int count = 2 * reach_ + 1;
    return static_cast<std::size_t>(index < 0        ? index + count
                                    : index >= count ? index - count
                                                     : index);
  }

  const GreyImage& image_;
  Columns tile_;
  int reach_;
  int y_;
  int current_ = 0;  // slot of row y_
  AlignedRows<std::int16_t> rows_;
};

/// The largest radius that the kernel's workspace holds.
inline constexpr int kMaxGlRadius = 63;

/// One row of the texture, with an order for each pixel.
/// \param rows  reach >= radius
/// \param radius  1 .. kMaxGlRadius
/// \param orders  v in [0, 1) for each pixel; read up to a vector past the row's end
/// \param texture  receives width() samples and no more
void gl_row(const ExtendedRows& rows, int radius, const float* orders, float* texture);

/// The same with one order for all pixels.
void gl_row(const ExtendedRows& rows, int radius, double order, float* texture);

}  // namespace touchtrial::engine

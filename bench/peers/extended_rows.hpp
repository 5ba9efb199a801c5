/// \file A window of image rows that moves down, each row continued by symmetric extension.
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/aligned_rows.hpp"

#include <cstddef>
#include <cstdint>

namespace touchtrial::bench {

/// Rows y - reach .. y + reach of an image for one y at a time, as 16-bit integers, with `reach`
/// mirrored samples at both ends. Every row is widened once; memory is (2 * reach + 1) rows,
/// whatever the height.
/// Keeps a reference to the image; not thread-safe.
class ExtendedRows {
 public:
  /// \param image  not empty  \param reach  >= 1; may exceed the image
  ExtendedRows(const GreyImage& image, int reach);

  /// Moves to the next row; the first call moves to row 0. \pre there is one
  void next_row();

  /// The first sample, in column 0, of the row `offset` below the present one; columns -reach ..
  /// width - 1 + reach may be read, and a vector more. Valid until next_row.
  /// \param offset  -reach .. reach
  [[nodiscard]] const std::int16_t* row(int offset) const noexcept {
    return rows_.row(slot(y_ + offset));
  }
  [[nodiscard]] int width() const noexcept { return image_.width(); }

 private:
  void load(int y);
  /// Rows y - reach .. y + reach have slots of their own, whatever y.
  [[nodiscard]] std::size_t slot(int y) const noexcept {
    return static_cast<std::size_t>(y + reach_) % (2 * static_cast<std::size_t>(reach_) + 1);
  }

  const GreyImage& image_;
  int reach_;
  int y_ = -1;
  engine::AlignedRows<std::int16_t> rows_;
};

}  // namespace touchtrial::bench

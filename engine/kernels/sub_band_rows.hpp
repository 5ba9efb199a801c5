/// \file DAUB4 sub-bands of an image row by row, in exact integers and little memory.
/// Source: docs/method.md, "DAUB4 sub-bands".
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/wavelet_rows.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchtrial {

/// The first letter is the filter along x.
enum class SubBand { ll, lh, hl, hh };

/// Walks down the image; keeps four filtered rows of it and the last three rows of the sub-bands.
/// Keeps a reference to the image; not thread-safe.
class SubBandRows {
 public:
  /// \param image  not empty
  explicit SubBandRows(const GreyImage& image);

  [[nodiscard]] int height() const noexcept { return (image_.height() + 1) / 2; }
  [[nodiscard]] int width() const noexcept { return (image_.width() + 1) / 2; }

  /// Computes the next row of all sub-bands; the first call row 0. \pre there is one
  void next_row();

  /// The same, straight to values; row() then does not have them.
  /// \param to  a row of width() samples for each sub-band, in the order of the enumeration
  void next_row(const std::array<float*, 4>& to);

  /// \param y  the present row or one of the two before it
  /// \return columns -1 .. width(), the outer two mirrored, and a vector of slack
  [[nodiscard]] RootRow row(SubBand band, int y) noexcept;

 private:
  void advance();
  [[nodiscard]] std::array<RootRow, 4> filtered_rows(int part) noexcept;
  [[nodiscard]] RootRow filtered_row(int part, int y) noexcept;
  void filter_image_row(int y);

  const GreyImage& image_;
  int y_ = -1;
  AlignedRows<std::uint8_t> extended_;
  AlignedRows<std::int16_t> filtered_;  // low and high along x of image rows 2y .. 2y + 3
  AlignedRows<std::int16_t> bands_;
};

}  // namespace touchtrial

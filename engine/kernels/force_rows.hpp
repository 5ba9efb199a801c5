/// \file The tangential force of the neighbourhood of 3 x 3, row by row, in single precision.
/// Source: docs/method.md, "Force field".
#pragma once

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/field_rows.hpp"

#include <array>
#include <cstddef>

namespace touchtrial::engine {

/// Takes the rows of a surface from top to bottom and gives the forces of each as soon as the next
/// one is there; keeps three rows.
///
/// The surface is zero outside of the image as far as slopes go; what neighbours that do not exist
/// would then exert, a weight times the pixel itself, is put right at the border.
class ForceRows {
 public:
  explicit ForceRows(int width);

  /// Where the next row of the surface is to be written: width samples; a vector before and behind
  /// them may be overwritten.
  [[nodiscard]] float* next_surface() noexcept { return surface_row(rows_); }

  /// Takes the row that was written there, and gives the forces of the row before it.
  /// \param force_x,force_y  receive width samples and no more; of no meaning for the first row
  /// \param beside  a row of at most `width` samples that is moved meanwhile
  void add_row(float* force_x, float* force_y, const StreamedRow& beside = {});

  /// The forces of the last row. To be called once, after one row at least.
  void finish(float* force_x, float* force_y);

 private:
  [[nodiscard]] float* surface_row(int row) noexcept { return samples_.row(slot(row)); }
  [[nodiscard]] SlopeRow& slopes(int row) noexcept { return slopes_[slot(row)]; }
  [[nodiscard]] static std::size_t slot(int row) noexcept {
    return static_cast<std::size_t>(row + kRows) % kRows;
  }
  void fill_border(const float* surface, const SlopeRow& out) const;
  void mend_ends(int row, bool last, float* force_x);

  static constexpr int kRows = 3;
  int width_;
  int rows_ = 0;                // taken
  AlignedRows<float> samples_;  // kRows rows of the surface, and their slopes
  std::array<SlopeRow, kRows> slopes_;
};

}  // namespace touchtrial::engine

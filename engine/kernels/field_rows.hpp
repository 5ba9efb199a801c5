/// \file Rows of the picture and of the force of a texture, and copies past the caches, in single
/// precision, vectorised for every target. Source: docs/method.md, "Force field".
#pragma once

#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/streamed_row.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {

/// clamp(floor(128 + T + 0.5), 0, 255), exactly, for any floats; NaN gives 0.
/// \param width  >= 0; no more than this many samples are read or written
void picture_row(const float* texture, int width, std::uint8_t* picture);

/// Moves a whole row past the caches.
void move_row(const StreamedRow& row);

/// The tangential force with 3 x 3 neighbours, row by row. Takes the rows of a surface from top to
/// bottom, and gives the forces of each as soon as the next row is there. Keeps three rows.
///
/// As far as slopes are concerned, the surface is 0 outside the image. The force that the missing
/// neighbours would then exert is a weight times the pixel itself; it is corrected at the border.
class ForceRows {
 public:
  explicit ForceRows(int width);

  /// Where the caller writes the next row of the surface: `width` samples. A vector at both ends
  /// may be overwritten.
  [[nodiscard]] float* next_surface() noexcept { return surface_row(rows_); }

  /// Takes the row written at next_surface(), and gives the forces of the row before it.
  /// \param force_x,force_y  receive `width` samples and no more; meaningless for the first row
  /// \param beside  a row of at most `width` samples to move meanwhile
  void add_row(float* force_x, float* force_y, const StreamedRow& beside = {});

  /// The forces of the last row. Call it once, after at least one row.
  void finish(float* force_x, float* force_y);

  /// The slopes of one row of the surface G from left to right, and the weights of its columns in
  /// the slope from row to row: G(x - 1) - G(x + 1) and G(x) + (G(x - 1) + G(x + 1)) / 2.
  struct Slopes {
    float* across = nullptr;
    float* weight = nullptr;
  };

 private:
  [[nodiscard]] float* surface_row(int row) noexcept { return samples_.row(slot(row)); }
  [[nodiscard]] Slopes& slopes(int row) noexcept { return slopes_[slot(row)]; }
  [[nodiscard]] static std::size_t slot(int row) noexcept {
    return static_cast<std::size_t>(row + kRows) % kRows;
  }
  void fill_border(const float* surface, const Slopes& out) const;
  void correct_ends(int row, bool last, float* force_x);

  static constexpr int kRows = 3;
  int width_;
  int rows_ = 0;                // taken so far
  AlignedRows<float> samples_;  // kRows rows of the surface, and their slopes
  std::array<Slopes, kRows> slopes_;
};

}  // namespace touchtrial::engine

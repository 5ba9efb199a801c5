/// \file The composite sub-band gradient of an image in single precision, in one pass over it.
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/sub_band_rows.hpp"

#include <cstddef>

namespace touchtrial {

/// CSGV at half resolution, and its maximum, which is only known after the last row: it forces a
/// second pass. Takes as many bytes as the image has pixels.
class HalfGradient {
 public:
  /// \param bands  of which no row has been computed
  /// \param on_row  called as on_row(y) after row y of the sub-bands was computed
  template <typename OnRow>
  HalfGradient(SubBandRows& bands, OnRow on_row)
      : height_(bands.height()),
        width_(bands.width()),
        rows_(static_cast<std::size_t>(height_), static_cast<std::size_t>(width_), 0,
              RowUse::plane) {
    for (int y = 0; y < height_; ++y) {
      bands.next_row();
      on_row(y);
      if (y > 0) compute(bands, y - 1);
    }
    compute(bands, height_ - 1);
  }

  [[nodiscard]] const float* row(int y) const noexcept {
    return rows_.row(static_cast<std::size_t>(y));
  }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] float largest() const noexcept { return largest_; }

 private:
  void compute(SubBandRows& bands, int y);

  int height_;
  int width_;
  AlignedRows<float> rows_;
  float largest_ = 0.0F;
};

}  // namespace touchtrial

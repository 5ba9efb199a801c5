/// \file The composite sub-band gradient of an image in single precision, in one pass over it.
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/column_filter.hpp"

#include <cstddef>

namespace touchtrial::engine {

/// CSGV at half resolution, and its maximum, which is only known after the last row: it forces a
/// second pass. Takes as many bytes as the image has pixels.
class HalfGradient {
 public:
  /// \param image  not empty
  explicit HalfGradient(const GreyImage& image);

  [[nodiscard]] const float* row(int y) const noexcept {
    return rows_.row(static_cast<std::size_t>(y));
  }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] float largest() const noexcept { return largest_; }

 private:
  void compute(const GreyImage& image, Columns columns);

  int height_;
  int width_;
  AlignedRows<float> rows_;
  float largest_ = 0.0F;
};

}  // namespace touchtrial::engine

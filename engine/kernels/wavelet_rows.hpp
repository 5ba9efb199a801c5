/// \file Computes rows of DAUB4 sub-bands in exact integers, vectorised for every target.
/// Source: docs/method.md, "Sub-bands".
///
/// The taps are (1 + s, 3 + s, 3 - s, 1 - s) / (4 sqrt 2) with s = sqrt 3, so a filter's
/// output is `whole` + `root` * s with integers `whole` and `root`. The approximation s = 5042 /
/// 2911 is closer than a float can be, and with it a sub-band of an 8-bit image is a whole number
/// of 26 bits divided by kWaveletDivisor. Nothing is rounded before differences are taken. So the
/// error of a gradient does not depend on brightness, a flat image has gradient 0, and a negative
/// image has the gradient of its positive.
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/strips.hpp"

#include <array>
#include <cstdint>

namespace touchtrial::engine {

/// The approximation of sqrt 3; from the Pell equation 5042^2 - 3 * 2911^2 = 1.
inline constexpr int kRootNumerator = 5042;
inline constexpr int kRootDenominator = 2911;

/// The divisor of the integers. Its reciprocal as a float is so precise that every quotient a float
/// can represent is exact.
inline constexpr int kWaveletDivisor = 32 * kRootDenominator;
inline constexpr float kWaveletScale = 1.0F / static_cast<float>(kWaveletDivisor);

/// Four rows of an image filtered along y: `whole` and `root` of the low and high filters.
struct FilteredRows {
  std::int16_t* low_whole = nullptr;
  std::int16_t* low_root = nullptr;
  std::int16_t* high_whole = nullptr;
  std::int16_t* high_root = nullptr;
};

/// Filters an image along y, one row of the sub-bands at a time. Keeps one filtered row and a
/// reference to the image. Not thread-safe.
class ColumnFilter {
 public:
  /// \param image  not empty
  /// \param columns  of the sub-bands: all, or at least two
  ColumnFilter(const GreyImage& image, Columns columns);

  /// The filtered rows for row y of the sub-bands. They start at the first column, and are mirrored
  /// at the right end as far as filter_along_x() reads. Valid until the next call.
  /// \param y  0 .. ceil(height / 2) - 1
  [[nodiscard]] const FilteredRows& row(int y);

 private:
  void extend(std::int16_t* row) const;

  const GreyImage& image_;
  int first_x_;
  int image_width_;     // columns read from the image
  int filtered_width_;  // columns of a filtered row
  AlignedRows<std::int16_t> samples_;
  FilteredRows rows_;
};

/// One row of each sub-band, in the order ll, lh, hl, hh. The first letter is the filter along x.
template <typename Sample>
using BandRows = std::array<Sample*, 4>;

/// Filters along x and downsamples by two, to the sub-bands' values in single precision.
/// \param rows  2 * count + 2 samples each, and two vectors of slack
/// \param out  receives exactly `count` samples each
void filter_along_x(const FilteredRows& rows, int count, const BandRows<float>& out);

}  // namespace touchtrial::engine

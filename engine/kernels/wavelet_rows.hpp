/// \file Rows of DAUB4 sub-bands in exact integers, vectorised for every target.
/// Source: docs/method.md, "Sub-bands".
///
/// The taps are (1 + s, 3 + s, 3 - s, 1 - s) / (4 sqrt 2) with s = sqrt 3, so a filter gives whole
/// numbers: `whole` + `root` s. The approximation s = 5042 / 2911 is closer than a float can be,
/// and with it a sub-band of an 8-bit image is a whole number of 26 bits divided by
/// kWaveletDivisor. Nothing is rounded before differences are taken. So the error of a gradient
/// does not depend on the image's brightness, a flat image has exactly no gradient, and a negative
/// exactly that of its positive.
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

/// The divisor of the whole numbers. Its reciprocal as a float is so close that every quotient that
/// a float can represent is exact.
inline constexpr int kWaveletDivisor = 32 * kRootDenominator;
inline constexpr float kWaveletScale = 1.0F / static_cast<float>(kWaveletDivisor);

/// Four rows of an image, filtered along y: whole and root of the low and of the high filter.
struct FilteredRows {
  std::int16_t* low_whole = nullptr;
  std::int16_t* low_root = nullptr;
  std::int16_t* high_whole = nullptr;
  std::int16_t* high_root = nullptr;
};

/// An image filtered along y, one row of the sub-bands at a time. Holds one filtered row and a
/// reference to the image. Not thread-safe.
class ColumnFilter {
 public:
  /// \param image  not empty
  /// \param columns  of the sub-bands to be made: all, or at least two
  ColumnFilter(const GreyImage& image, Columns columns);

  /// The filtered rows for row y of the sub-bands. They start at the first of the columns, and are
  /// mirrored at the right end as far as filter_along_x() reads. Valid until the next call.
  /// \param y  0 .. ceil(height / 2) - 1
  [[nodiscard]] const FilteredRows& row(int y);

 private:
  void extend(std::int16_t* row) const;

  const GreyImage& image_;
  int first_x_;
  int available_;  // columns of the image that are read
  int wanted_;     // columns of a filtered row
  AlignedRows<std::int16_t> samples_;
  FilteredRows rows_;
};

/// One row of each sub-band, in the order ll, lh, hl, hh. The first letter is the filter along x.
template <typename Sample>
using BandRows = std::array<Sample*, 4>;

/// Filters along x, and keeps every second sample: the values of the sub-bands in single precision.
/// \param rows  2 * count + 2 samples each, and two vectors of slack
/// \param out  receives `count` samples each and no more
void filter_along_x(const FilteredRows& rows, int count, const BandRows<float>& out);

}  // namespace touchtrial::engine

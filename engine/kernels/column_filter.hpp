/// \file An image filtered along y by DAUB4, one row of the sub-bands at a time.
/// Source: docs/method.md, "DAUB4 sub-bands".
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/wavelet_rows.hpp"

#include <cstdint>

namespace touchtrial::engine {

/// Columns first .. last - 1 of something.
struct Columns {
  int first;
  int last;
  [[nodiscard]] int count() const noexcept { return last - first; }
};

/// Keeps one filtered row, and a reference to the image; not thread-safe.
class ColumnFilter {
 public:
  /// \param image  not empty
  /// \param columns  those of the sub-bands that will be made of it: all, or at least two
  ColumnFilter(const GreyImage& image, Columns columns);

  /// What row y of the sub-bands is made of, from the first of its columns on, continued to the
  /// right as far as filter_along_x reads. Valid until the next call.
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

}  // namespace touchtrial::engine

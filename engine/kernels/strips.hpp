/// \file Divides a picture into strips of rows, to use all cores, and into tiles of columns, whose
/// rows stay in the first-level cache.
#pragma once

#include "core/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {

/// A range of rows, first .. last - 1.
struct Rows {
  int first;
  int last;
};

/// A range of columns, first .. last - 1.
struct Columns {
  int first;
  int last;
  [[nodiscard]] int count() const noexcept { return last - first; }
};

/// The size from which several threads pay off: a megapixel takes half a millisecond.
inline constexpr std::int64_t kMinParallelPixels = 1'000'000;

/// Calls work(strip) for strips that cover all rows: on all cores from kMinParallelPixels, else
/// once on the caller's thread. Strips begin at even rows and depend only on the picture's size,
/// and so do sums over strips.
template <typename Work>
void for_each_strip(int height, int width, Work work) {
  constexpr int kStrips = 16;
  if (std::int64_t{height} * width < kMinParallelPixels) {
    work(Rows{0, height});
    return;
  }
  const int rows = (height + 2 * kStrips - 1) / (2 * kStrips) * 2;
  const int strips = (height + rows - 1) / rows;
  in_parallel(0, static_cast<std::size_t>(strips), [&](std::size_t i) {
    const int first = static_cast<int>(i) * rows;
    work(Rows{first, std::min(first + rows, height)});
  });
}

/// The size from which a plane far exceeds the second-level cache, so that kernels prefetch rows
/// (prefetch_row) and work on tiles.
inline constexpr std::int64_t kMinLargePixels = std::int64_t{1} << 21;

/// Calls work(columns) for tiles of 512 columns from left to right, or once for all columns if the
/// picture is not large. Tiles begin at even columns.
template <typename Work>
void for_each_tile(int height, int width, Work work) {
  constexpr int kColumns = 512;
  const int columns = std::int64_t{height} * width < kMinLargePixels ? width : kColumns;
  for (int first = 0; first < width; first += columns) {
    work(Columns{first, std::min(first + columns, width)});
  }
}

}  // namespace touchtrial::engine

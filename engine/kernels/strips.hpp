/// \file Strips of a picture's rows, for kernels that use all cores on one large picture, and tiles
/// of its columns, whose rows stay in the first-level cache.
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

/// From this size on several threads pay off: a megapixel takes half a millisecond.
inline constexpr std::int64_t kThreadsFromPixels = 1'000'000;

/// Calls work(strip) for strips that together are all rows, on all cores if the picture has
/// kThreadsFromPixels, else for one strip on the caller's thread. Strips begin at even rows. They
/// depend on the picture's size alone, and so do results that are sums over strips.
template <typename Work>
void for_each_strip(int height, int width, Work work) {
  constexpr int kStrips = 16;
  if (std::int64_t{height} * width < kThreadsFromPixels) {
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

/// From this size on a plane is too large for the second-level cache by far: rows are asked for
/// before they are needed (fetch_ahead), and tiles of rows are worked on.
inline constexpr std::int64_t kLargeFromPixels = std::int64_t{1} << 21;

/// Calls work(columns) for tiles of some 512 columns that together are all, from left to right, or
/// for all at once if the picture is not large. A tile's rows fit into the first-level cache. Tiles
/// begin at even columns.
template <typename Work>
void for_each_tile(int height, int width, Work work) {
  constexpr int kColumns = 512;
  const int columns = std::int64_t{height} * width < kLargeFromPixels ? width : kColumns;
  for (int first = 0; first < width; first += columns) {
    work(Columns{first, std::min(first + columns, width)});
  }
}

}  // namespace touchtrial::engine

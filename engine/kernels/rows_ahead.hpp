/// \file Prefetches rows of a large plane.
///
/// Processors look ahead within a page of memory, and a row of a large picture is a page or more.
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/strips.hpp"

#include <cstddef>

#include <hwy/cache_control.h>

namespace touchtrial::engine {

/// Asks for columns of row y, if there is such a row, of a plane that is large. Changes
/// nothing.
template <typename Sample>
void fetch_ahead(const Plane<Sample>& plane, int y, Columns columns) noexcept {
  constexpr int kPerLine = 64 / sizeof(Sample);
  if (plane.size() < kLargeFromPixels || y < 0 || y >= plane.height()) return;
  const Sample* const row = plane.row(y).data();
  for (int x = columns.first; x < columns.last; x += kPerLine) hwy::Prefetch(row + x);
}

}  // namespace touchtrial::engine

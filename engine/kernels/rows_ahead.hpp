/// \file Prefetches rows of a large plane.
///
/// Hardware prefetches only within a page of memory, and a row of a large picture is a page or
/// more.
#pragma once

#include "core/plane.hpp"
#include "engine/kernels/strips.hpp"

#include <cstddef>

#include <hwy/cache_control.h>

namespace touchtrial::engine {

/// Prefetches columns of row y of a large plane; does nothing for smaller planes and missing rows.
template <typename Sample>
void prefetch_row(const Plane<Sample>& plane, int y, Columns columns) noexcept {
  constexpr int kPerLine = 64 / sizeof(Sample);
  if (plane.size() < kMinLargePixels || y < 0 || y >= plane.height()) return;
  const Sample* const row = plane.row(y).data();
  for (int x = columns.first; x < columns.last; x += kPerLine) hwy::Prefetch(row + x);
}

}  // namespace touchtrial::engine

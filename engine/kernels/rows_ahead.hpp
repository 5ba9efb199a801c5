/// \file Asks for rows of a large plane before they are needed.
///
/// Processors look ahead within a page of memory, and a row of a large picture is a page or more.
#pragma once

#include "core/plane.hpp"

#include <cstddef>

#include <hwy/cache_control.h>

namespace touchtrial::engine {

/// Asks for samples 0 .. count - 1 of row y, if there is one, of a plane that is too large for the
/// second-level cache by far. Changes nothing.
template <typename Sample>
void fetch_ahead(const Plane<Sample>& plane, int y, int count) noexcept {
  constexpr std::size_t kFarFromSamples = std::size_t{1} << 21;
  constexpr int kPerLine = 64 / sizeof(Sample);
  if (plane.size() < kFarFromSamples || y < 0 || y >= plane.height()) return;
  const Sample* const row = plane.row(y).data();
  for (int x = 0; x < count; x += kPerLine) hwy::Prefetch(row + x);
}

}  // namespace touchtrial::engine

/// \file Copies of rows to planes that are too large for the caches.
///
/// Stores past the caches are as fast as memory, but a burst of them stalls everything that
/// follows. So a kernel that has something else to compute moves such a row one vector at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace touchtrial::engine {

/// Samples 0 .. count - 1 remain to be moved. `to` is a multiple of a cache line. Call
/// hwy::FlushStream() before another thread reads the samples.
struct StreamedRow {
  const float* from = nullptr;
  float* to = nullptr;
  int count = 0;
};

/// Copies the ends of a row, which share cache lines with other rows.
/// \return the middle of the row, which remains to be moved
inline StreamedRow start_stream(const float* from, int width, float* to) {
  constexpr std::uintptr_t kLineBytes = 64;
  constexpr int kLineSamples = kLineBytes / sizeof(float);
  const std::uintptr_t past_line = reinterpret_cast<std::uintptr_t>(to) % kLineBytes;
  const int head =
      std::min(width, static_cast<int>((kLineBytes - past_line) % kLineBytes / sizeof(float)));
  const int count = (width - head) / kLineSamples * kLineSamples;
  std::copy_n(from, head, to);
  std::copy(from + head + count, from + width, to + head + count);
  return {from + head, to + head, count};
}

}  // namespace touchtrial::engine

/// \file Half-sample symmetric extension: the image mirrored at its edges, edge samples repeated.
/// Source: docs/method.md, "Symmetric extension".
#pragma once

namespace touchtrial::engine {

/// The sample that stands at index i of the endlessly mirrored sequence 0 .. n-1:
/// .. 1 0 | 0 1 .. n-1 | n-1 n-2 ..
/// \param i  any index, however far outside (|i| < 2^30)
/// \param n  length of the sequence, 1 .. 2^28
[[nodiscard]] constexpr int symmetric_index(int i, int n) noexcept {
  if (i >= 0 && i < n) return i;
  const int period = 2 * n;
  const int remainder = i % period;
  const int folded = remainder < 0 ? remainder + period : remainder;
  return folded < n ? folded : period - 1 - folded;
}

}  // namespace touchtrial::engine

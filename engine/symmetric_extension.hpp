/// \file Half-sample symmetric extension: mirrors an image at its edges and repeats the edge
/// samples. Source: docs/method.md, "Borders".
#pragma once

namespace touchtrial::engine {

/// The index of the sample at position i of the endlessly mirrored sequence 0 .. n-1:
/// .. 1 0 | 0 1 .. n-1 | n-1 n-2 ..
/// \param i  any index, however far outside (|i| < 2^30)
/// \param n  length of the sequence, 1 .. 2^28
[[nodiscard]] constexpr int symmetric_index(int i, int n) noexcept {
  if (i >= 0 && i < n) return i;
  if (i < 0 && i >= -n) return -1 - i;  // no division for the nearest mirror images
  if (i >= n && i < 2 * n) return 2 * n - 1 - i;
  const int period = 2 * n;
  const int remainder = i % period;
  const int position = remainder < 0 ? remainder + period : remainder;
  return position < n ? position : period - 1 - position;
}

/// Writes `margin` mirrored samples before and after a row, which may be shorter than the margin.
/// \param row  its first sample; both sides must have memory for the margin
/// \param width  of the row, >= 1
template <typename Sample>
void mirror_ends(Sample* row, int width, int margin) noexcept {
  for (int i = 1; i <= margin; ++i) {
    row[-i] = row[symmetric_index(-i, width)];
    row[width - 1 + i] = row[symmetric_index(width - 1 + i, width)];
  }
}

}  // namespace touchtrial::engine

/// \file Rows of scratch memory for the kernels: aligned, and safe to access past their ends.
#pragma once

#include <algorithm>
#include <cstddef>

#include <hwy/aligned_allocator.h>

namespace touchtrial::engine {

/// The longest vector of any target, in bytes. A kernel may run this far past the end of a row.
inline constexpr std::size_t kVectorBytes = 64;

/// The use of rows. Scratch rows are zeroed and spaced so that neighbours do not compete for lines
/// of the first-level cache. Plane rows are uninitialised and adjacent.
enum class RowUse { scratch, plane };

/// `count` rows of `width` samples. Each row has `margin` samples before it, and `margin` samples
/// plus a vector after it.
template <typename Sample>
class AlignedRows {
 public:
  AlignedRows(std::size_t count, std::size_t width, std::size_t margin,
              RowUse use = RowUse::scratch)
      : row_offset_(round_up_to_vectors(margin)),
        stride_(spread(row_offset_ + round_up_to_vectors(width + margin) + kPerVector, use)),
        samples_(hwy::AllocateAligned<Sample>(count * stride_)) {
    if (use == RowUse::scratch) std::fill_n(samples_.get(), count * stride_, Sample{0});
  }

  /// The first sample of a row, aligned to kVectorBytes.
  [[nodiscard]] Sample* row(std::size_t index) noexcept {
    return samples_.get() + index * stride_ + row_offset_;
  }
  [[nodiscard]] const Sample* row(std::size_t index) const noexcept {
    return samples_.get() + index * stride_ + row_offset_;
  }

 private:
  static constexpr std::size_t kPerVector = kVectorBytes / sizeof(Sample);
  static constexpr std::size_t round_up_to_vectors(std::size_t samples) {
    return (samples + kPerVector - 1) / kPerVector * kPerVector;
  }
  /// A load waits for a store to an address with the same last twelve bits, which rows of a width
  /// near a power of two would cause in all columns. A stride of a page and slightly more than a
  /// quarter avoids it.
  static constexpr std::size_t spread(std::size_t stride, RowUse use) {
    constexpr std::size_t kPage = 4096 / sizeof(Sample);
    constexpr std::size_t kOffset = 18 * kPerVector;
    if (use == RowUse::plane) return stride;
    return stride + (kPage + kOffset - stride % kPage) % kPage;
  }

  std::size_t row_offset_;
  std::size_t stride_;
  hwy::AlignedFreeUniquePtr<Sample[]> samples_;
};

}  // namespace touchtrial::engine

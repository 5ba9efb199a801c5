/// \file Scratch rows for the kernels: aligned, and safe to read and write past their ends.
#pragma once

#include <algorithm>
#include <cstddef>

#include <hwy/aligned_allocator.h>

namespace touchtrial::engine {

/// The longest vector of any target, in bytes: how far a kernel may run past the end of a row.
inline constexpr std::size_t kVectorBytes = 64;

/// What rows are for: scratch rows are zero at first and lie so that neighbours do not contend for
/// the same places of the first-level cache; the rows of a plane are undefined and lie close.
enum class RowUse { scratch, plane };

/// `count` rows of `width` samples, each with `margin` samples before it, and as many and one more
/// vector behind it.
template <typename Sample>
class AlignedRows {
 public:
  AlignedRows(std::size_t count, std::size_t width, std::size_t margin,
              RowUse use = RowUse::scratch)
      : lead_(whole_vectors(margin)),
        stride_(spread(lead_ + whole_vectors(width + margin) + kPerVector, use)),
        samples_(hwy::AllocateAligned<Sample>(count * stride_)) {
    if (use == RowUse::scratch) std::fill_n(samples_.get(), count * stride_, Sample{0});
  }

  /// The first sample of a row, at an address that is a multiple of kVectorBytes.
  [[nodiscard]] Sample* row(std::size_t index) noexcept {
    return samples_.get() + index * stride_ + lead_;
  }
  [[nodiscard]] const Sample* row(std::size_t index) const noexcept {
    return samples_.get() + index * stride_ + lead_;
  }

 private:
  static constexpr std::size_t kPerVector = kVectorBytes / sizeof(Sample);
  static constexpr std::size_t whole_vectors(std::size_t samples) {
    return (samples + kPerVector - 1) / kPerVector * kPerVector;
  }
  /// Loads wait for stores whose addresses have the same last twelve bits. Rows of a width near a
  /// power of two would have them, in all columns: a stride of a page and more than a quarter keeps
  /// neighbouring rows well apart.
  static constexpr std::size_t spread(std::size_t stride, RowUse use) {
    constexpr std::size_t kPage = 4096 / sizeof(Sample);
    constexpr std::size_t kApart = 18 * kPerVector;
    if (use == RowUse::plane) return stride;
    return stride + (kPage + kApart - stride % kPage) % kPage;
  }

  std::size_t lead_;
  std::size_t stride_;
  hwy::AlignedFreeUniquePtr<Sample[]> samples_;
};

}  // namespace touchtrial::engine

/// \file Scratch rows for the kernels: aligned, and safe to read and write past their ends.
#pragma once

#include <algorithm>
#include <cstddef>

#include <hwy/aligned_allocator.h>

namespace touchtrial {

/// The longest vector of any target, in bytes: how far a kernel may run past the end of a row.
inline constexpr std::size_t kVectorBytes = 64;

enum class RowFill { zero, none };

/// `count` rows of `width` samples, each with `margin` samples before it, and as many and one more
/// vector behind it.
template <typename Sample>
class AlignedRows {
 public:
  /// \param fill  none leaves the samples undefined, for large planes that are written anyway
  AlignedRows(std::size_t count, std::size_t width, std::size_t margin,
              RowFill fill = RowFill::zero)
      : lead_(whole_vectors(margin)),
        stride_(lead_ + whole_vectors(width + margin) + kPerVector),
        samples_(hwy::AllocateAligned<Sample>(count * stride_)) {
    if (fill == RowFill::zero) std::fill_n(samples_.get(), count * stride_, Sample{0});
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

  std::size_t lead_;
  std::size_t stride_;
  hwy::AlignedFreeUniquePtr<Sample[]> samples_;
};

}  // namespace touchtrial

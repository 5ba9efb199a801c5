/// \file Percentiles of many durations, from a fixed number of bins.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace touchtrial::device {

/// Counts durations in bins that are 1 ns wide below 32 ns and at most 1/32 of their lower edge
/// (3.1 %) above. The last bin takes everything beyond 2^36 ns (69 s). `add` allocates nothing and
/// never throws. Belongs to one thread at a time. Size: 8 KiB.
class DurationHistogram {
 public:
  using Duration = std::chrono::nanoseconds;

  /// \param duration  a negative one counts as 0
  void add(Duration duration) noexcept;
  void add(const DurationHistogram& other) noexcept;

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// \return the longest duration, exactly; zero if there is none
  [[nodiscard]] Duration worst() const noexcept { return Duration(worst_ns_); }
  /// \param share  in (0, 1]; 0.99 is the 99th percentile
  /// \return the percentile by nearest rank, rounded up to the end of its bin but never beyond the
  ///   longest duration; zero if there is none
  [[nodiscard]] double percentile_us(double share) const noexcept;

 private:
  static constexpr std::size_t kBins = 32 * 32;
  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t worst_ns_ = 0;
};

}  // namespace touchtrial::device

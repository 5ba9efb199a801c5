#include "device/servo/duration_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace touchtrial::device {
namespace {

/// The number of bins per octave. Below this many ns, every nanosecond has its own bin.
constexpr std::int64_t kSteps = 32;
constexpr int kStepBits = 5;

std::size_t bin_of(std::int64_t ns) noexcept {
  if (ns < kSteps) return static_cast<std::size_t>(ns);
  const int octave =
      static_cast<int>(std::bit_width(static_cast<std::uint64_t>(ns))) - 1 - kStepBits;
  const auto step = static_cast<std::size_t>(ns >> octave);  // in [kSteps, 2 kSteps)
  return static_cast<std::size_t>(octave * kSteps) + step;
}

std::int64_t min_of_bin(std::size_t index) noexcept {
  const auto i = static_cast<std::int64_t>(index);
  if (i < kSteps) return i;
  const std::int64_t octave = i / kSteps - 1;
  return (i - octave * kSteps) << octave;
}

}  // namespace

void DurationHistogram::add(Duration duration) noexcept {
  const std::int64_t ns = std::max<std::int64_t>(duration.count(), 0);
  ++counts_[std::min(bin_of(ns), kBins - 1)];
  ++count_;
  worst_ns_ = std::max(worst_ns_, ns);
}

void DurationHistogram::add(const DurationHistogram& other) noexcept {
  for (std::size_t i = 0; i < kBins; ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  worst_ns_ = std::max(worst_ns_, other.worst_ns_);
}

double DurationHistogram::percentile_us(double share) const noexcept {
  const double rank = std::max(1.0, std::ceil(share * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    below += counts_[i];
    if (static_cast<double>(below) < rank) continue;
    // The last nanosecond of a bin is one before the next bin; the last bin is unbounded.
    const std::int64_t last_ns = i + 1 == kBins ? worst_ns_ : min_of_bin(i + 1) - 1;
    return static_cast<double>(std::min(last_ns, worst_ns_)) * 1e-3;
  }
  return static_cast<double>(worst_ns_) * 1e-3;
}

}  // namespace touchtrial::device

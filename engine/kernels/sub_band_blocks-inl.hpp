/// \file Computes blocks of DAUB4 sub-bands from rows filtered along y, for one target.
// Included once for every target by the kernels.
#include "engine/kernels/wavelet_rows.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#ifndef TOUCHTRIAL_SUB_BAND_TAPS
#define TOUCHTRIAL_SUB_BAND_TAPS
namespace touchtrial::engine {
namespace {

/// The weights of four neighbouring samples.
using Taps = std::array<std::int16_t, 4>;

/// The weights of `whole` and of `root` in kRootDenominator * (p + q s) * (whole + root s).
struct RootTaps {
  Taps whole;
  Taps root;
};

constexpr RootTaps root_taps(const std::array<int, 4>& p, const std::array<int, 4>& q) {
  RootTaps taps{};
  for (std::size_t m = 0; m < 4; ++m) {
    taps.whole[m] = static_cast<std::int16_t>(kRootDenominator * p[m] + kRootNumerator * q[m]);
    taps.root[m] = static_cast<std::int16_t>(3 * kRootDenominator * q[m] + kRootNumerator * p[m]);
  }
  return taps;
}

constexpr RootTaps kLow = root_taps({1, 3, 3, 1}, {1, 1, -1, -1});
constexpr RootTaps kHigh = root_taps({1, -3, 3, -1}, {-1, 1, 1, -1});

}  // namespace
}  // namespace touchtrial::engine
#endif

#if defined(TOUCHTRIAL_SUB_BAND_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TOUCHTRIAL_SUB_BAND_BLOCKS_INL
#undef TOUCHTRIAL_SUB_BAND_BLOCKS_INL
#else
#define TOUCHTRIAL_SUB_BAND_BLOCKS_INL
#endif

#include "engine/kernels/real_pairs-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

using WideInteger = hn::Vec<WideIntegers>;

/// The number of sub-band samples in a vector.
constexpr int kHalfBlock = static_cast<int>(hn::MaxLanes(WideIntegers()));

/// Adds even * samples[0] + odd * samples[1], even * samples[2] + odd * samples[3], .. to the lanes
/// of a sum.
HWY_INLINE WideInteger add_pairs(const std::int16_t* samples, std::int16_t even, std::int16_t odd,
                                 WideInteger sum) {
  const WideIntegers wide;
#if HWY_TARGET == HWY_SCALAR
  return hn::Add(sum, hn::Set(wide, samples[0] * even + samples[1] * odd));
#else
  const Integers d;
  const auto packed = static_cast<std::uint16_t>(even) |
                      (static_cast<std::uint32_t>(static_cast<std::uint16_t>(odd)) << 16);
  const auto weights = hn::BitCast(d, hn::Set(wide, static_cast<std::int32_t>(packed)));
  auto upper_sum = hn::Zero(wide);
  sum = hn::ReorderWidenMulAccumulate(wide, hn::LoadU(d, samples), weights, sum, upper_sum);
  return hn::RearrangeToOddPlusEven(sum, upper_sum);
#endif
}

/// A block of a sub-band, times kWaveletDivisor.
HWY_INLINE WideInteger band_block(const std::int16_t* whole, const std::int16_t* root,
                                  const RootTaps& taps, int i) {
  const auto zero = hn::Zero(WideIntegers());
  const auto wholes = add_pairs(whole + 2 * i + 2, taps.whole[2], taps.whole[3],
                                add_pairs(whole + 2 * i, taps.whole[0], taps.whole[1], zero));
  return add_pairs(root + 2 * i + 2, taps.root[2], taps.root[3],
                   add_pairs(root + 2 * i, taps.root[0], taps.root[1], wholes));
}

/// Calls visit(band, block) with a block of each sub-band.
template <class Visit>
HWY_INLINE void for_each_band(const FilteredRows& rows, int i, const Visit& visit) {
  const auto ll = band_block(rows.low_whole, rows.low_root, kLow, i);
  const auto hl = band_block(rows.low_whole, rows.low_root, kHigh, i);
  visit(0, ll);
  visit(2, hl);
  const auto lh = band_block(rows.high_whole, rows.high_root, kLow, i);
  const auto hh = band_block(rows.high_whole, rows.high_root, kHigh, i);
  visit(1, lh);
  visit(3, hh);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#endif

#include "engine/kernels/wavelet_rows.hpp"

#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/wavelet_rows.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/real_pairs-inl.hpp"
// clang-format on

#ifndef TOUCHTRIAL_WAVELET_ROWS_ONCE
#define TOUCHTRIAL_WAVELET_ROWS_ONCE
namespace touchtrial::engine {
namespace {

/// The weights of four neighbouring samples.
using Taps = std::array<std::int16_t, 4>;

/// kRootDenominator times (p + q s)(whole + root s): the weights of the wholes and of the roots.
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

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

using WideInteger = hn::Vec<WideIntegers>;

/// How many samples of a sub-band a vector holds.
constexpr int kHalfBlock = static_cast<int>(hn::MaxLanes(WideIntegers()));

HWY_INLINE Integer tripled(Integer v) {
  return hn::Add(hn::Add(v, v), v);
}

/// Filters a block of the four rows at `x`, and writes it at `to` of the outputs.
HWY_INLINE void filter_block(const std::array<const std::uint8_t*, 4>& rows, int x,
                             const FilteredRows& out, int to) {
  const Integers d;
  const auto x0 = load_bytes(rows[0] + x);
  const auto x1 = load_bytes(rows[1] + x);
  const auto x2 = load_bytes(rows[2] + x);
  const auto x3 = load_bytes(rows[3] + x);
  const auto outer_sum = hn::Add(x0, x3);
  const auto inner_sum = hn::Add(x1, x2);
  const auto outer_difference = hn::Sub(x0, x3);
  const auto inner_difference = hn::Sub(x1, x2);
  hn::StoreU(hn::Add(outer_sum, tripled(inner_sum)), d, out.low_whole + to);
  hn::StoreU(hn::Add(outer_difference, inner_difference), d, out.low_root + to);
  hn::StoreU(hn::Sub(outer_difference, tripled(inner_difference)), d, out.high_whole + to);
  hn::StoreU(hn::Sub(inner_sum, outer_sum), d, out.high_root + to);
}

/// \param width  >= 1; no more than this many samples are read
/// \param out  receives `width` samples each; a vector behind them may be overwritten
void along_y(const std::array<const std::uint8_t*, 4>& rows, int width, const FilteredRows& out) {
  int x = 0;
  for (; x + kBlock <= width; x += kBlock) filter_block(rows, x, out, x);
  if (x == width) return;
  if (width >= kBlock) {
    filter_block(rows, width - kBlock, out, width - kBlock);
    return;
  }
  std::uint8_t copies[4][kBlock] = {};
  for (std::size_t m = 0; m < 4; ++m) std::copy_n(rows[m], width, copies[m]);
  filter_block({copies[0], copies[1], copies[2], copies[3]}, 0, out, 0);
}

/// Adds even * from[0] + odd * from[1], even * from[2] + odd * from[3], .. to the lanes of a sum.
HWY_INLINE WideInteger add_pairs(const std::int16_t* from, std::int16_t even, std::int16_t odd,
                                 WideInteger sum) {
  const WideIntegers wide;
#if HWY_TARGET == HWY_SCALAR
  return hn::Add(sum, hn::Set(wide, from[0] * even + from[1] * odd));
#else
  const Integers d;
  const auto both = static_cast<std::uint16_t>(even) |
                    (static_cast<std::uint32_t>(static_cast<std::uint16_t>(odd)) << 16);
  const auto weights = hn::BitCast(d, hn::Set(wide, static_cast<std::int32_t>(both)));
  auto other = hn::Zero(wide);
  sum = hn::ReorderWidenMulAccumulate(wide, hn::LoadU(d, from), weights, sum, other);
  return hn::RearrangeToOddPlusEven(sum, other);
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

/// Calls to(band, block) with a block of each sub-band.
template <class To>
HWY_INLINE void for_each_band(const FilteredRows& rows, int i, const To& to) {
  const auto ll = band_block(rows.low_whole, rows.low_root, kLow, i);
  const auto hl = band_block(rows.low_whole, rows.low_root, kHigh, i);
  to(0, ll);
  to(2, hl);
  const auto lh = band_block(rows.high_whole, rows.high_root, kLow, i);
  const auto hh = band_block(rows.high_whole, rows.high_root, kHigh, i);
  to(1, lh);
  to(3, hh);
}

/// Writes the new row over the last but one.
void sobel_along_x(const FilteredRows& rows, int count, const SobelRows out) {
  const WideIntegers d;
  for (int i = 0; i < count; i += kHalfBlock) {
    for_each_band(rows, i, [&](std::size_t band, WideInteger block) HWY_ATTR {
      const auto middle = hn::Load(d, out.last[band] + i);
      const auto first = hn::Load(d, out.last_but_one[band] + i);
      hn::Store(block, d, out.last_but_one[band] + i);
      const auto wings = hn::Add(first, block);
      hn::Store(hn::Add(wings, hn::Add(middle, middle)), d, out.smoothed[band] + i);
      hn::Store(hn::Sub(block, first), d, out.difference[band] + i);
    });
  }
}

void values_block(const FilteredRows& rows, int i, const BandRows<float>& out, int to) {
  const Reals d;
  for_each_band(rows, i, [&](std::size_t band, WideInteger block) HWY_ATTR {
    hn::StoreU(hn::Mul(hn::ConvertTo(d, block), hn::Set(d, kWaveletScale)), d, out[band] + to);
  });
}

void values_along_x(const FilteredRows& rows, int count, const BandRows<float>& out) {
  int i = 0;
  for (; i + kHalfBlock <= count; i += kHalfBlock) values_block(rows, i, out, i);
  if (i == count) return;
  if (count >= kHalfBlock) {
    values_block(rows, count - kHalfBlock, out, count - kHalfBlock);
    return;
  }
  float all[4][kHalfBlock];
  values_block(rows, 0, {all[0], all[1], all[2], all[3]}, 0);
  for (std::size_t band = 0; band < 4; ++band) std::copy_n(all[band], count, out[band]);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(along_y);
HWY_EXPORT(sobel_along_x);
HWY_EXPORT(values_along_x);

}  // namespace

ColumnFilter::ColumnFilter(const GreyImage& image, Columns columns)
    : image_(image),
      first_x_(2 * columns.first),
      available_(std::min(2 * columns.count() + 2, image.width() - first_x_)),
      wanted_(2 * columns.count() + 2),
      samples_(4, static_cast<std::size_t>(wanted_), kVectorBytes / sizeof(std::int16_t)),
      rows_{samples_.row(0), samples_.row(1), samples_.row(2), samples_.row(3)} {}

const FilteredRows& ColumnFilter::row(int y) {
  std::array<const std::uint8_t*, 4> rows;
  for (int m = 0; m < 4; ++m) {
    rows[m] = image_.row(symmetric_index(2 * y + m, image_.height())).data() + first_x_;
  }
  HWY_DYNAMIC_DISPATCH(along_y)(rows, available_, rows_);
  for (std::size_t part = 0; part < 4; ++part) extend(samples_.row(part));
  return rows_;
}

void ColumnFilter::extend(std::int16_t* row) const {
  for (int x = available_; x < wanted_; ++x) {
    row[x] = row[symmetric_index(first_x_ + x, image_.width()) - first_x_];
  }
}

void filter_along_x(const FilteredRows& rows, int count, SobelRows& out) {
  HWY_DYNAMIC_DISPATCH(sobel_along_x)(rows, count, out);
  std::swap(out.last, out.last_but_one);
}

void filter_along_x(const FilteredRows& rows, int count, const BandRows<float>& out) {
  HWY_DYNAMIC_DISPATCH(values_along_x)(rows, count, out);
}

}  // namespace touchtrial::engine
#endif

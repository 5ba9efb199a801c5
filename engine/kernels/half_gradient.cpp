#include "engine/kernels/half_gradient.hpp"

#include "engine/kernels/rows_ahead.hpp"
#include "engine/order_map.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/half_gradient.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/sub_band_blocks-inl.hpp"
// clang-format on

#ifndef TOUCHTRIAL_SOBEL_ROWS_ONCE
#define TOUCHTRIAL_SOBEL_ROWS_ONCE
namespace touchtrial::engine {
namespace {

/// Derivatives of rows of each sub-band, along x: [-1 0 1], and [1 2 1]. Of the last row and of the
/// one before, whose place the new row takes.
struct SobelRows {
  BandRows<std::int32_t> last_slope{};
  BandRows<std::int32_t> old_slope{};
  BandRows<std::int32_t> last_smoothed{};
  BandRows<std::int32_t> old_smoothed{};
};

}  // namespace
}  // namespace touchtrial::engine
#endif

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE WideInteger one_right(WideInteger, WideInteger next) {
  return next;
}
HWY_INLINE WideInteger one_left(WideInteger before, WideInteger) {
  return before;
}
#else
constexpr int kLaneBytes = sizeof(std::int32_t);

/// Two neighbouring blocks as one, without the first `kLanes` lanes of it.
template <int kLanes>
HWY_INLINE WideInteger joined(WideInteger block, WideInteger next) {
#if HWY_TARGET <= HWY_AVX3
  return WideInteger{_mm512_alignr_epi32(next.raw, block.raw, kLanes)};
#elif HWY_TARGET <= HWY_AVX2
  const WideIntegers d;
  const auto middle = hn::ConcatLowerUpper(d, next, block);
  if constexpr (kLanes < kHalfBlock / 2) {
    return hn::CombineShiftRightBytes<kLanes * kLaneBytes>(d, middle, block);
  } else {
    return hn::CombineShiftRightBytes<(kLanes - kHalfBlock / 2) * kLaneBytes>(d, next, middle);
  }
#else
  return hn::CombineShiftRightBytes<kLanes * kLaneBytes>(WideIntegers(), next, block);
#endif
}

/// The right neighbour of each sample of a block, and the left one.
HWY_INLINE WideInteger one_right(WideInteger block, WideInteger next) {
  return joined<1>(block, next);
}
HWY_INLINE WideInteger one_left(WideInteger before, WideInteger block) {
  return joined<kHalfBlock - 1>(before, block);
}
#endif

/// Adds the square root of v. With long vectors the root is the processor's estimate to 14 bits,
/// corrected by one step with the exact remainder: the same to the last bit or nearly,
/// and exact for a square.
HWY_INLINE Real add_estimated_root(Real v, Real sum) {
#if HWY_TARGET <= HWY_AVX3
  const Reals d;
  const auto inverse = hn::ApproximateReciprocalSqrt(hn::Max(v, hn::Set(d, 1e-30F)));
  const auto estimate = hn::Mul(v, inverse);
  const auto remainder = hn::NegMulAdd(estimate, estimate, v);
  return hn::Add(sum, hn::MulAdd(hn::Mul(remainder, hn::Set(d, 0.5F)), inverse, estimate));
#else
  return hn::Add(sum, hn::Sqrt(v));  // the estimate of shorter vectors is too coarse
#endif
}

/// Computes half of the roots in the slow unit for square roots, which works beside the other
/// units.
HWY_INLINE Real sum_of_roots(const std::array<Real, 4>& squares) {
  auto sum = hn::Sqrt(squares[0]);
  sum = add_estimated_root(squares[1], sum);
  sum = hn::Add(sum, hn::Sqrt(squares[2]));
  sum = add_estimated_root(squares[3], sum);
  return hn::Mul(sum, hn::Set(Reals(), kWaveletScale));
}

/// The squared length of a band's gradient at a block, before kWaveletScale, and the block's new
/// derivatives in place of old ones.
/// \param left,right  the neighbours of the block's samples
HWY_INLINE Real squared_gradient(WideInteger left, WideInteger block, WideInteger right,
                                 const SobelRows& rows, std::size_t band, int i) {
  const WideIntegers d;
  const Reals reals;
  const auto slope = hn::Sub(right, left);
  const auto smoothed = hn::Add(hn::Add(left, right), hn::Add(block, block));
  const auto last_slope = hn::Load(d, rows.last_slope[band] + i);
  const auto wings = hn::Add(hn::Load(d, rows.old_slope[band] + i), slope);
  hn::Store(slope, d, rows.old_slope[band] + i);
  const auto across = hn::Add(wings, hn::Add(last_slope, last_slope));
  const auto down = hn::Sub(smoothed, hn::Load(d, rows.old_smoothed[band] + i));
  hn::Store(smoothed, d, rows.old_smoothed[band] + i);
  const auto x = hn::ConvertTo(reals, across);
  const auto y = hn::ConvertTo(reals, down);
  return hn::MulAdd(x, x, hn::Mul(y, y));
}

/// Writes the first lanes of a block, and no more.
HWY_INLINE void store_first(Real block, int count, float* to) {
  const Reals d;
#if HWY_TARGET <= HWY_AVX3
  hn::BlendedStore(block, hn::FirstN(d, static_cast<std::size_t>(count)), d, to);
#else
  alignas(64) float lanes[kHalfBlock];
  hn::Store(block, d, lanes);
  std::copy_n(lanes, count, to);
#endif
}

/// Takes a new row of the sub-bands into `state`, in registers from the filter to the gradient.
/// \param rows  as for filter_along_x()
/// \param inside  samples whose neighbours are among the `count`; an end is counted as its own
///   neighbour beyond
/// \param csgv  of the row before: receives `count` samples and no more
/// \return the largest of the samples inside
float row_of_csgv(const FilteredRows& rows, int count, Columns inside, const SobelRows state,
                  float* csgv) {
  const WideIntegers d;
  const Reals reals;
  const auto largest_inside = [&](int i, Real roots, Real largest) HWY_ATTR {
    const auto at = hn::Iota(d, i);
    const auto counts =
        hn::And(hn::Gt(at, hn::Set(d, inside.first - 1)), hn::Lt(at, hn::Set(d, inside.last)));
    return hn::Max(largest, hn::IfThenElseZero(hn::RebindMask(reals, counts), roots));
  };
  std::array<WideInteger, 4> left;
  std::array<WideInteger, 4> block;
  std::array<Real, 4> squares = {hn::Zero(reals), hn::Zero(reals), hn::Zero(reals),
                                 hn::Zero(reals)};
  for_each_band(rows, 0, [&](std::size_t band, WideInteger first) HWY_ATTR {
    block[band] = first;  // its first sample is its own left neighbour
    left[band] = one_left(hn::Set(d, hn::GetLane(first)), first);
  });
  auto largest = hn::Zero(reals);
  int i = 0;
  for (; i + kHalfBlock < count; i += kHalfBlock) {
    const auto roots = sum_of_roots(squares);
    hn::StoreU(roots, reals, csgv + std::max(i - kHalfBlock, 0));
    largest = i == kHalfBlock ? largest_inside(0, roots, largest) : hn::Max(largest, roots);
    for_each_band(rows, i + kHalfBlock, [&](std::size_t band, WideInteger next) HWY_ATTR {
      squares[band] =
          squared_gradient(left[band], block[band], one_right(block[band], next), state, band, i);
      left[band] = one_left(block[band], next);
      block[band] = next;
    });
  }
  if (i > 0) {
    const auto roots = sum_of_roots(squares);
    hn::StoreU(roots, reals, csgv + i - kHalfBlock);
    largest = largest_inside(i - kHalfBlock, roots, largest);
  }
  // The row's last sample is its own right neighbour.
  const int rest = count - i;
  const auto is_last = hn::Eq(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(rest - 1)));
  for (std::size_t band = 0; band < 4; ++band) {
    const auto right = hn::IfThenElse(is_last, block[band], one_right(block[band], block[band]));
    squares[band] = squared_gradient(left[band], block[band], right, state, band, i);
  }
  const auto ends = sum_of_roots(squares);
  store_first(ends, rest, csgv + i);
  return hn::GetLane(hn::MaxOfLanes(reals, largest_inside(i, ends, largest)));
}

/// Each lane twice, in the same order.
HWY_INLINE RealPair doubled(Real v) {
#if HWY_TARGET == HWY_SCALAR
  return {v, v};
#else
  const Reals d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  alignas(64) std::int32_t places[2 * kLanes];
  for (std::size_t i = 0; i < 2 * kLanes; ++i) places[i] = static_cast<std::int32_t>(i / 2);
  return {hn::TableLookupLanes(v, hn::SetTableIndices(d, places)),
          hn::TableLookupLanes(v, hn::SetTableIndices(d, places + kLanes))};
#endif
}

void row_of_orders(const float* csgv, int count, float largest, float* out) {
  const Reals d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto middle_slope = hn::Set(d, 1.0F / (3.0F * largest));
  const auto steep_slope = hn::Set(d, 1.0F / (2.0F * largest));
  const auto middle_base = hn::Set(d, 0.666F);
  const auto steep_base = hn::Set(d, 0.499F);
  const auto flat_below = hn::Set(d, static_cast<float>(kFlatBelowCsgv));
  const auto steep_above = hn::Set(d, static_cast<float>(kSteepAboveCsgv));
  const auto block = [&](const float* from, int i) HWY_ATTR {
    const auto v = hn::LoadU(d, from);
    const auto middle = hn::MulAdd(v, middle_slope, middle_base);
    const auto steep = hn::MulAdd(v, steep_slope, steep_base);
    const auto order = hn::IfThenElse(hn::Gt(v, steep_above), steep, middle);
    const RealPair twice = doubled(hn::IfThenElseZero(hn::Ge(v, flat_below), order));
    hn::StoreU(twice.lower, d, out + 2 * i);
    hn::StoreU(twice.upper, d, out + 2 * i + lanes);
  };
  int i = 0;
  for (; i + lanes <= count; i += lanes) block(csgv + i, i);
  if (i == count) return;
  alignas(64) float ends[kHalfBlock] = {};
  std::copy_n(csgv + i, count - i, ends);
  block(ends, i);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(row_of_csgv);
HWY_EXPORT(row_of_orders);

constexpr std::size_t kVectorSamples = kVectorBytes / sizeof(std::int32_t);

/// The derivatives of the last two rows.
class SobelState {
 public:
  explicit SobelState(int columns)
      : samples_(16, static_cast<std::size_t>(columns), kVectorSamples) {
    std::size_t next = 0;
    for (auto* kind :
         {&rows_.last_slope, &rows_.old_slope, &rows_.last_smoothed, &rows_.old_smoothed}) {
      for (std::int32_t*& row : *kind) row = samples_.row(next++);
    }
  }

  /// \param csgv  of the row that was last
  float add(const FilteredRows& rows, int count, Columns inside, float* csgv) {
    const float largest = HWY_DYNAMIC_DISPATCH(row_of_csgv)(rows, count, inside, rows_, csgv);
    std::swap(rows_.last_slope, rows_.old_slope);
    std::swap(rows_.last_smoothed, rows_.old_smoothed);
    return largest;
  }

 private:
  AlignedRows<std::int32_t> samples_;
  SobelRows rows_;
};

}  // namespace

HalfGradient::HalfGradient(const GreyImage& image, Plane<float>& room)
    : room_(room), height_((image.height() + 1) / 2), width_((image.width() + 1) / 2) {
  std::mutex mutex;
  for_each_strip(height_, 4 * width_, [&](Rows rows) {
    for_each_tile(image.height(), image.width(), [&](Columns tile) {
      const float largest = compute(image, rows, tile);
      const std::lock_guard lock(mutex);
      largest_ = std::max(largest_, largest);
    });
  });
}

float HalfGradient::compute(const GreyImage& image, Rows rows, Columns tile) {
  const Columns wanted = {tile.first / 2, (tile.last + 1) / 2};
  const Columns all = {std::max(wanted.first - 1, 0), std::min(wanted.last + 1, width_)};
  const int before = wanted.first - all.first;
  const Columns inside = {before, before + wanted.count()};
  ColumnFilter filter(image, all);
  SobelState state(all.count());
  float largest = 0.0F;
  for (int y = rows.first - 1; y <= rows.last; ++y) {
    // The first two rows have no gradient yet: what is written is written again.
    const int of = std::max(y - 1, rows.first);
    fetch_ahead(room_, 2 * (of + 1), tile);
    const float of_row = state.add(filter.row(symmetric_index(y, height_)), all.count(), inside,
                                   place(of, tile) - before);
    if (y > rows.first) largest = std::max(largest, of_row);
  }
  return largest;
}

void order_row(const float* csgv, int count, float largest, float* out) {
  HWY_DYNAMIC_DISPATCH(row_of_orders)(csgv, count, largest, out);
}

}  // namespace touchtrial::engine
#endif

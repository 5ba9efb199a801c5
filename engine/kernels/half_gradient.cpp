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
// clang-format off: the next header is compiled for the target selected above.
#include "engine/kernels/sub_band_blocks-inl.hpp"
// clang-format on

#ifndef TOUCHTRIAL_SOBEL_ROWS_ONCE
#define TOUCHTRIAL_SOBEL_ROWS_ONCE
namespace touchtrial::engine {
namespace {

/// The last two rows of each sub-band, filtered along x by [-1 0 1] (slope) and by [1 2 1]
/// (smoothed). A new row replaces the older one.
struct SobelRows {
  BandRows<std::int32_t> newer_slope{};
  BandRows<std::int32_t> older_slope{};
  BandRows<std::int32_t> newer_smoothed{};
  BandRows<std::int32_t> older_smoothed{};
};

}  // namespace
}  // namespace touchtrial::engine
#endif

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE WideInteger right_neighbours(WideInteger, WideInteger next) {
  return next;
}
HWY_INLINE WideInteger left_neighbours(WideInteger previous, WideInteger) {
  return previous;
}
#else
constexpr int kLaneBytes = sizeof(std::int32_t);

/// Joins two neighbouring blocks and drops the first `kLanes` lanes.
template <int kLanes>
HWY_INLINE WideInteger shift_lanes(WideInteger block, WideInteger next) {
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

HWY_INLINE WideInteger right_neighbours(WideInteger block, WideInteger next) {
  return shift_lanes<1>(block, next);
}
HWY_INLINE WideInteger left_neighbours(WideInteger previous, WideInteger block) {
  return shift_lanes<kHalfBlock - 1>(previous, block);
}
#endif

/// Adds the square root of v to `sum`. Long vectors use the processor's 14-bit estimate, corrected
/// by one step with the exact remainder: exact for squares, else correct to about the last bit.
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

/// Computes half of the roots in the slow square root unit, in parallel with the other units.
HWY_INLINE Real sum_of_roots(const std::array<Real, 4>& squares) {
  auto sum = hn::Sqrt(squares[0]);
  sum = add_estimated_root(squares[1], sum);
  sum = hn::Add(sum, hn::Sqrt(squares[2]));
  sum = add_estimated_root(squares[3], sum);
  return hn::Mul(sum, hn::Set(Reals(), kWaveletScale));
}

/// Returns the squared gradient of a band's block, not scaled by kWaveletScale, and stores the
/// block's derivatives over the oldest ones.
/// \param left,right  neighbours of the block's samples
HWY_INLINE Real squared_gradient(WideInteger left, WideInteger block, WideInteger right,
                                 const SobelRows& rows, std::size_t band, int i) {
  const WideIntegers d;
  const Reals reals;
  const auto slope = hn::Sub(right, left);
  const auto smoothed = hn::Add(hn::Add(left, right), hn::Add(block, block));
  const auto newer_slope = hn::Load(d, rows.newer_slope[band] + i);
  const auto wings = hn::Add(hn::Load(d, rows.older_slope[band] + i), slope);
  hn::Store(slope, d, rows.older_slope[band] + i);
  const auto difference_x = hn::Add(wings, hn::Add(newer_slope, newer_slope));
  const auto difference_y = hn::Sub(smoothed, hn::Load(d, rows.older_smoothed[band] + i));
  hn::Store(smoothed, d, rows.older_smoothed[band] + i);
  const auto x = hn::ConvertTo(reals, difference_x);
  const auto y = hn::ConvertTo(reals, difference_y);
  return hn::MulAdd(x, x, hn::Mul(y, y));
}

/// Writes only the first `count` lanes of a block.
HWY_INLINE void store_lanes(Real block, int count, float* target) {
  const Reals d;
#if HWY_TARGET <= HWY_AVX3
  hn::BlendedStore(block, hn::FirstN(d, static_cast<std::size_t>(count)), d, target);
#else
  alignas(64) float lanes[kHalfBlock];
  hn::Store(block, d, lanes);
  std::copy_n(lanes, count, target);
#endif
}

/// Adds a new row of the sub-bands to `state`. Data stay in registers from filter to gradient.
/// \param rows  as for filter_along_x()
/// \param interior  samples with both neighbours among the `count`, where the ends of the image are
///   their own neighbours
/// \param csgv  receives `count` samples of the previous row
/// \return the largest of the interior samples
float compute_csgv_row(const FilteredRows& rows, int count, Columns interior, const SobelRows state,
                       float* csgv) {
  const WideIntegers d;
  const Reals reals;
  const auto max_interior = [&](int i, Real roots, Real largest) HWY_ATTR {
    const auto index = hn::Iota(d, i);
    const auto is_inside = hn::And(hn::Gt(index, hn::Set(d, interior.first - 1)),
                                   hn::Lt(index, hn::Set(d, interior.last)));
    return hn::Max(largest, hn::IfThenElseZero(hn::RebindMask(reals, is_inside), roots));
  };
  std::array<WideInteger, 4> left;
  std::array<WideInteger, 4> block;
  std::array<Real, 4> squares = {hn::Zero(reals), hn::Zero(reals), hn::Zero(reals),
                                 hn::Zero(reals)};
  for_each_band(rows, 0, [&](std::size_t band, WideInteger first) HWY_ATTR {
    block[band] = first;  // its first sample is its own left neighbour
    left[band] = left_neighbours(hn::Set(d, hn::GetLane(first)), first);
  });
  auto largest = hn::Zero(reals);
  int i = 0;
  for (; i + kHalfBlock < count; i += kHalfBlock) {
    const auto roots = sum_of_roots(squares);
    hn::StoreU(roots, reals, csgv + std::max(i - kHalfBlock, 0));
    largest = i == kHalfBlock ? max_interior(0, roots, largest) : hn::Max(largest, roots);
    for_each_band(rows, i + kHalfBlock, [&](std::size_t band, WideInteger next) HWY_ATTR {
      squares[band] = squared_gradient(left[band], block[band], right_neighbours(block[band], next),
                                       state, band, i);
      left[band] = left_neighbours(block[band], next);
      block[band] = next;
    });
  }
  if (i > 0) {
    const auto roots = sum_of_roots(squares);
    hn::StoreU(roots, reals, csgv + i - kHalfBlock);
    largest = max_interior(i - kHalfBlock, roots, largest);
  }
  // The row's last sample is its own right neighbour.
  const int remaining = count - i;
  const auto is_last = hn::Eq(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(remaining - 1)));
  for (std::size_t band = 0; band < 4; ++band) {
    const auto right =
        hn::IfThenElse(is_last, block[band], right_neighbours(block[band], block[band]));
    squares[band] = squared_gradient(left[band], block[band], right, state, band, i);
  }
  const auto ends = sum_of_roots(squares);
  store_lanes(ends, remaining, csgv + i);
  return hn::GetLane(hn::MaxOfLanes(reals, max_interior(i, ends, largest)));
}

/// Repeats each lane twice, in the same order.
HWY_INLINE RealPair repeat_lanes(Real v) {
#if HWY_TARGET == HWY_SCALAR
  return {v, v};
#else
  const Reals d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  alignas(64) std::int32_t indices[2 * kLanes];
  for (std::size_t i = 0; i < 2 * kLanes; ++i) indices[i] = static_cast<std::int32_t>(i / 2);
  return {hn::TableLookupLanes(v, hn::SetTableIndices(d, indices)),
          hn::TableLookupLanes(v, hn::SetTableIndices(d, indices + kLanes))};
#endif
}

void compute_order_row(const float* csgv, int count, float largest, float* out) {
  const Reals d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto middle_slope = hn::Set(d, 1.0F / (3.0F * largest));
  const auto steep_slope = hn::Set(d, 1.0F / (2.0F * largest));
  const auto middle_base = hn::Set(d, 0.666F);
  const auto steep_base = hn::Set(d, 0.499F);
  const auto flat_below = hn::Set(d, static_cast<float>(kFlatBelowCsgv));
  const auto steep_above = hn::Set(d, static_cast<float>(kSteepAboveCsgv));
  const auto write_block = [&](const float* source, int i) HWY_ATTR {
    const auto v = hn::LoadU(d, source);
    const auto middle = hn::MulAdd(v, middle_slope, middle_base);
    const auto steep = hn::MulAdd(v, steep_slope, steep_base);
    const auto order = hn::IfThenElse(hn::Gt(v, steep_above), steep, middle);
    const RealPair pairs = repeat_lanes(hn::IfThenElseZero(hn::Ge(v, flat_below), order));
    hn::StoreU(pairs.lower, d, out + 2 * i);
    hn::StoreU(pairs.upper, d, out + 2 * i + lanes);
  };
  int i = 0;
  for (; i + lanes <= count; i += lanes) write_block(csgv + i, i);
  if (i == count) return;
  alignas(64) float ends[kHalfBlock] = {};
  std::copy_n(csgv + i, count - i, ends);
  write_block(ends, i);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(compute_csgv_row);
HWY_EXPORT(compute_order_row);

constexpr std::size_t kVectorSamples = kVectorBytes / sizeof(std::int32_t);

/// The derivatives of the last two rows.
class SobelState {
 public:
  explicit SobelState(int columns)
      : samples_(16, static_cast<std::size_t>(columns), kVectorSamples) {
    std::size_t next = 0;
    for (auto* kind :
         {&rows_.newer_slope, &rows_.older_slope, &rows_.newer_smoothed, &rows_.older_smoothed}) {
      for (std::int32_t*& row : *kind) row = samples_.row(next++);
    }
  }

  /// Adds a new row of the sub-bands.
  /// \param csgv  receives CSGV of the previous row
  /// \return the largest of its interior samples
  float add(const FilteredRows& rows, int count, Columns interior, float* csgv) {
    const float largest =
        HWY_DYNAMIC_DISPATCH(compute_csgv_row)(rows, count, interior, rows_, csgv);
    std::swap(rows_.newer_slope, rows_.older_slope);
    std::swap(rows_.newer_smoothed, rows_.older_smoothed);
    return largest;
  }

 private:
  AlignedRows<std::int32_t> samples_;
  SobelRows rows_;
};

}  // namespace

HalfGradient::HalfGradient(const GreyImage& image, Plane<float>& scratch)
    : scratch_(scratch), height_((image.height() + 1) / 2), width_((image.width() + 1) / 2) {
  std::mutex mutex;
  for_each_strip(height_, 4 * width_, [&](Rows rows) {
    for_each_tile(image.height(), image.width(), [&](Columns tile) {
      const float largest = compute(image, rows, tile);
      const std::lock_guard lock(mutex);
      max_csgv_ = std::max(max_csgv_, largest);
    });
  });
}

float HalfGradient::compute(const GreyImage& image, Rows rows, Columns tile) {
  const Columns half_tile = {tile.first / 2, (tile.last + 1) / 2};
  const Columns extended = {std::max(half_tile.first - 1, 0), std::min(half_tile.last + 1, width_)};
  const int margin = half_tile.first - extended.first;
  const Columns interior = {margin, margin + half_tile.count()};
  ColumnFilter filter(image, extended);
  SobelState state(extended.count());
  float largest = 0.0F;
  for (int y = rows.first - 1; y <= rows.last; ++y) {
    // The first two rows have no gradient yet, and their output is overwritten.
    const int output_y = std::max(y - 1, rows.first);
    prefetch_row(scratch_, 2 * (output_y + 1), tile);
    const float row_largest = state.add(filter.row(symmetric_index(y, height_)), extended.count(),
                                        interior, row_start(output_y, tile) - margin);
    if (y > rows.first) largest = std::max(largest, row_largest);
  }
  return largest;
}

void order_row(const float* csgv, int count, float largest, float* out) {
  HWY_DYNAMIC_DISPATCH(compute_order_row)(csgv, count, largest, out);
}

}  // namespace touchtrial::engine
#endif

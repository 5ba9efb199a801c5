#include "engine/kernels/csgv_row.hpp"

#include "engine/order_map.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/csgv_row.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/real_pairs-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace touchtrial {
namespace HWY_NAMESPACE {
namespace {

/// once + 2 * twice as reals; it may not fit 16 bits. Multiplying interleaved pairs and adding them
/// up costs no more than widening would. The lanes come shuffled between 128-bit blocks.
HWY_INLINE RealPair shuffled_sum(Integer once, Integer twice) {
  const Reals d;
  const WideIntegers wide;
#if HWY_TARGET == HWY_SCALAR
  const auto doubled = hn::ShiftLeft<1>(hn::PromoteTo(wide, twice));
  return {hn::ConvertTo(d, hn::Add(hn::PromoteTo(wide, once), doubled)), hn::Zero(d)};
#else
  const Integers integers;
  const auto weights = hn::BitCast(integers, hn::Set(wide, 0x00020001));  // 1, 2, 1, 2 ..
  const auto zero = hn::Zero(wide);
  auto odd0 = zero;
  auto odd1 = zero;
  const auto even0 = hn::ReorderWidenMulAccumulate(wide, hn::InterleaveLower(integers, once, twice),
                                                   weights, zero, odd0);
  const auto even1 = hn::ReorderWidenMulAccumulate(wide, hn::InterleaveUpper(integers, once, twice),
                                                   weights, zero, odd1);
  return {hn::ConvertTo(d, hn::RearrangeToOddPlusEven(even0, odd0)),
          hn::ConvertTo(d, hn::RearrangeToOddPlusEven(even1, odd1))};
#endif
}

/// Undoes the shuffle: the blocks l0 l1 .. and u0 u1 .. belong in the order l0 u0 l1 u1 ..
HWY_INLINE RealPair unshuffled(RealPair pair) {
#if HWY_TARGET == HWY_SCALAR
  return pair;
#else
  const Reals d;
  if constexpr (hn::MaxLanes(Reals()) == 8) {
    return {hn::ConcatLowerLower(d, pair.upper, pair.lower),
            hn::ConcatUpperUpper(d, pair.upper, pair.lower)};
  } else if constexpr (hn::MaxLanes(Reals()) == 16) {
    const auto first = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(pair.upper), pair.lower);
    const auto second = hn::OddEvenBlocks(pair.upper, hn::SwapAdjacentBlocks(pair.lower));
    return {hn::ConcatLowerLower(d, second, first), hn::ConcatUpperUpper(d, second, first)};
  } else {
    return pair;
  }
#endif
}

struct Sobel {
  RealPair x;
  RealPair y;
};

/// The Sobel gradient of one part, exact. Single differences fit 16 bits, their sums may not.
HWY_INLINE Sobel sobel(const std::int16_t* above, const std::int16_t* centre,
                       const std::int16_t* below, int i) {
  const Integers d;
  const auto north_west = hn::LoadU(d, above + i - 1);
  const auto north_east = hn::LoadU(d, above + i + 1);
  const auto south_west = hn::LoadU(d, below + i - 1);
  const auto south_east = hn::LoadU(d, below + i + 1);
  const auto across = hn::Sub(hn::LoadU(d, centre + i + 1), hn::LoadU(d, centre + i - 1));
  const auto down = hn::Sub(hn::LoadU(d, below + i), hn::LoadU(d, above + i));
  const auto falling = hn::Sub(south_east, north_west);
  const auto rising = hn::Sub(north_east, south_west);
  return {shuffled_sum(hn::Add(falling, rising), across),
          shuffled_sum(hn::Sub(falling, rising), down)};
}

/// The square root by the processor's estimate to 14 bits and one step with the exact remainder:
/// the same to the last bit or nearly, and the exact root of a square.
HWY_INLINE Real estimated_root(Real v) {
#if HWY_TARGET <= HWY_AVX3
  const Reals d;
  const auto inverse = hn::ApproximateReciprocalSqrt(hn::Max(v, hn::Set(d, 1e-30F)));
  const auto estimate = hn::Mul(v, inverse);
  const auto remainder = hn::NegMulAdd(estimate, estimate, v);
  return hn::MulAdd(hn::Mul(remainder, hn::Set(d, 0.5F)), inverse, estimate);
#else
  return hn::Sqrt(v);  // the estimate of shorter vectors is too coarse
#endif
}

HWY_INLINE Real squared_norm(Real whole_x, Real root_x, Real whole_y, Real root_y) {
  const auto root3 = hn::Set(Reals(), std::numbers::sqrt3_v<float>);
  const auto x = hn::MulAdd(root3, root_x, whole_x);
  const auto y = hn::MulAdd(root3, root_y, whole_y);
  return hn::MulAdd(x, x, hn::Mul(y, y));
}

HWY_INLINE RealPair gradient_norm(const BandRows& rows, int i) {
  const Sobel whole = sobel(rows.above.whole, rows.centre.whole, rows.below.whole, i);
  const Sobel root = sobel(rows.above.root, rows.centre.root, rows.below.root, i);
  // One of the two by the slow unit for roots, which works beside the others.
  return {hn::Sqrt(squared_norm(whole.x.lower, root.x.lower, whole.y.lower, root.y.lower)),
          estimated_root(squared_norm(whole.x.upper, root.x.upper, whole.y.upper, root.y.upper))};
}

HWY_INLINE RealPair csgv_block(const std::array<BandRows, 4>& bands, int i) {
  RealPair sum = gradient_norm(bands[0], i);
  for (std::size_t b = 1; b < bands.size(); ++b) {
    const RealPair more = gradient_norm(bands[b], i);
    sum = {hn::Add(sum.lower, more.lower), hn::Add(sum.upper, more.upper)};
  }
  const auto scale = hn::Set(Reals(), kWaveletScale);
  return unshuffled({hn::Mul(sum.lower, scale), hn::Mul(sum.upper, scale)});
}

float row_of_csgv(const std::array<BandRows, 4>& bands, int count, float* csgv) {
  const Reals d;
  auto largest = hn::Zero(d);
  int i = 0;
  for (; i + kBlock <= count; i += kBlock) {
    const RealPair block = csgv_block(bands, i);
    store_pair(block, csgv + i);
    largest = hn::Max(largest, hn::Max(block.lower, block.upper));
  }
  float of_row = hn::GetLane(hn::MaxOfLanes(d, largest));
  if (i < count) {
    store_pair(csgv_block(bands, i), csgv + i);
    of_row = std::max(of_row, *std::max_element(csgv + i, csgv + count));
  }
  return of_row;
}

/// Each lane twice, in order.
HWY_INLINE RealPair doubled(Real v) {
#if HWY_TARGET == HWY_SCALAR
  return {v, v};
#else
  const Reals d;
  return unshuffled({hn::InterleaveLower(d, v, v), hn::InterleaveUpper(d, v, v)});
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
  for (int i = 0; i < count; i += lanes) {
    const auto v = hn::LoadU(d, csgv + i);
    const auto middle = hn::MulAdd(v, middle_slope, middle_base);
    const auto steep = hn::MulAdd(v, steep_slope, steep_base);
    const auto order = hn::IfThenElse(hn::Gt(v, steep_above), steep, middle);
    const RealPair twice = doubled(hn::IfThenElseZero(hn::Ge(v, flat_below), order));
    hn::StoreU(twice.lower, d, out + 2 * i);
    hn::StoreU(twice.upper, d, out + 2 * i + lanes);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial {
namespace {

HWY_EXPORT(row_of_csgv);
HWY_EXPORT(row_of_orders);

}  // namespace

float csgv_row(const std::array<BandRows, 4>& bands, int count, float* csgv) {
  return HWY_DYNAMIC_DISPATCH(row_of_csgv)(bands, count, csgv);
}

void order_row(const float* csgv, int count, float largest, float* out) {
  HWY_DYNAMIC_DISPATCH(row_of_orders)(csgv, count, largest, out);
}

}  // namespace touchtrial
#endif

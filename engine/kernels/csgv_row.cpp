#include "engine/kernels/csgv_row.hpp"

#include "engine/order_map.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/csgv_row.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/real_pairs-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

/// The length of a band's gradient, before kWaveletScale, squared.
HWY_INLINE Real squared_gradient(const SobelRows& rows, std::size_t band, int i) {
  const WideIntegers d;
  const Reals reals;
  const std::int32_t* const smoothed = rows.smoothed[band] + i;
  const std::int32_t* const difference = rows.difference[band] + i;
  const auto across = hn::Sub(hn::LoadU(d, smoothed + 1), hn::LoadU(d, smoothed - 1));
  const auto centre = hn::LoadU(d, difference);
  const auto sides = hn::Add(hn::LoadU(d, difference - 1), hn::LoadU(d, difference + 1));
  const auto x = hn::ConvertTo(reals, across);
  const auto y = hn::ConvertTo(reals, hn::Add(sides, hn::Add(centre, centre)));
  return hn::MulAdd(x, x, hn::Mul(y, y));
}

/// Adds the square root by the processor's estimate to 14 bits and one step with the exact
/// remainder: the same to the last bit or nearly, and the exact root of a square.
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

/// Half of the roots by the slow unit for them, which works beside the others.
HWY_INLINE Real csgv_block(const SobelRows& rows, int i) {
  auto sum = hn::Sqrt(squared_gradient(rows, 0, i));
  sum = add_estimated_root(squared_gradient(rows, 1, i), sum);
  sum = hn::Add(sum, hn::Sqrt(squared_gradient(rows, 2, i)));
  sum = add_estimated_root(squared_gradient(rows, 3, i), sum);
  return hn::Mul(sum, hn::Set(Reals(), kWaveletScale));
}

float row_of_csgv(const SobelRows& rows, int first, int count, float* csgv) {
  const Reals d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto largest = hn::Zero(d);
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto block = csgv_block(rows, first + i);
    hn::StoreU(block, d, csgv + i);
    largest = hn::Max(largest, block);
  }
  float of_row = hn::GetLane(hn::MaxOfLanes(d, largest));
  if (i < count) {
    hn::StoreU(csgv_block(rows, first + i), d, csgv + i);
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
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(row_of_csgv);
HWY_EXPORT(row_of_orders);

}  // namespace

float csgv_row(const SobelRows& rows, int first, int count, float* csgv) {
  return HWY_DYNAMIC_DISPATCH(row_of_csgv)(rows, first, count, csgv);
}

void order_row(const float* csgv, int count, float largest, float* out) {
  HWY_DYNAMIC_DISPATCH(row_of_orders)(csgv, count, largest, out);
}

}  // namespace touchtrial::engine
#endif

#include "bench/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// This file includes itself, to be compiled once for every target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/limits.cpp"

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial::bench {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Reals = hn::ScalableTag<float>;

/// Writes whole vectors, starting at a cache line.
template <bool kPastCaches>
HWY_INLINE void stream_all(const std::uint8_t* bytes, float* samples, std::size_t count) {
  const Reals d;
  const hn::RebindToSigned<Reals> integers;
  const hn::Rebind<std::uint8_t, Reals> narrow;
  std::size_t i = 0;
  for (; i < count && reinterpret_cast<std::uintptr_t>(samples + i) % 64 != 0; ++i)
    samples[i] = bytes[i];
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) {
    const auto v = hn::ConvertTo(d, hn::PromoteTo(integers, hn::LoadU(narrow, bytes + i)));
    if constexpr (kPastCaches) {
      hn::Stream(v, d, samples + i);
    } else {
      hn::StoreU(v, d, samples + i);
    }
  }
  for (; i < count; ++i) samples[i] = bytes[i];
  if (kPastCaches) hwy::FlushStream();
}

void copy(const std::uint8_t* bytes, float* samples, std::size_t count, bool past_caches) {
  past_caches ? stream_all<true>(bytes, samples, count) : stream_all<false>(bytes, samples, count);
}

#if HWY_TARGET == HWY_SCALAR
float arithmetic(std::size_t) {
  return 0.0F;
}
#else

using Shorts = hn::Repartition<std::int16_t, Reals>;
using Longs = hn::RebindToSigned<Reals>;
using Short = hn::Vec<Shorts>;
using Long = hn::Vec<Longs>;
using Real = hn::Vec<Reals>;

constexpr std::size_t kBlock = hn::MaxLanes(Shorts());

/// Combines the differences of two rings into the texture by Horner's rule, with one order per
/// pixel.
HWY_INLINE Real texture_of_rings(Short ring_1, Short ring_2, Real order, bool upper) {
  const Reals d;
  const Longs wide;
  const hn::Half<Shorts> half;
  const auto real = [&](Short v) HWY_ATTR {
    return hn::ConvertTo(
        d, hn::PromoteTo(wide, upper ? hn::UpperHalf(half, v) : hn::LowerHalf(half, v)));
  };
  const auto decay = hn::NegMulAdd(order, hn::Set(d, 0.5F), hn::Set(d, 0.5F));
  const auto sum = hn::MulAdd(decay, real(ring_2), real(ring_1));
  return hn::Mul(hn::Mul(order, hn::Set(d, 0.125F)), sum);
}

/// \return a weighted sum of four values, as in the exact sub-bands
HWY_INLINE Long band_of(Short a, Short b, Short c, Short e, Short weights) {
  const Longs wide;
  auto sum = hn::Zero(wide);
  auto sum_1 = hn::Zero(wide);
  for (const Short v : {a, b, c, e}) {
    sum = hn::ReorderWidenMulAccumulate(wide, v, weights, sum, sum_1);
  }
  return hn::RearrangeToOddPlusEven(sum, sum_1);
}

HWY_INLINE Short triple(Short v) {
  return hn::Add(hn::Add(v, v), v);
}

float arithmetic(std::size_t pixels) {
  const Reals d;
  const Longs wide;
  const Shorts shorts;
  alignas(64) std::int16_t rows[8][2 * kBlock];
  for (std::size_t r = 0; r < 8; ++r) {
    for (std::size_t i = 0; i < 2 * kBlock; ++i) {
      rows[r][i] = static_cast<std::int16_t>((31 * r + 7 * i) % 256);
    }
  }
  auto textures = hn::Zero(d);
  auto bands = hn::Zero(wide);
  auto order = hn::Set(d, 0.3F);
  auto previous_inner = hn::Load(shorts, rows[6]);
  auto previous_outer = hn::Load(shorts, rows[7]);
  auto previous_whole = hn::Load(shorts, rows[7]);
  auto previous_root = previous_whole;
  const auto low = hn::Set(shorts, 97);
  const auto high = hn::Set(shorts, 61);
  for (std::size_t i = 0; i < pixels; i += 2 * kBlock) {
    // The two rows of a block share the sub-bands' filter, but each row has its own rings.
    const auto x0 = hn::Load(shorts, rows[0]);
    const auto x1 = hn::Load(shorts, rows[1]);
    const auto x2 = hn::Load(shorts, rows[2]);
    const auto x3 = hn::Load(shorts, rows[3]);
    const auto x4 = hn::Load(shorts, rows[4]);
    const auto x5 = hn::Load(shorts, rows[5]);
    for (const auto& rows_of_block :
         {std::array{x0, x1, x2, x3, x4}, std::array{x1, x2, x3, x4, x5}}) {
      const auto inner = hn::Add(hn::Add(rows_of_block[1], rows_of_block[3]), rows_of_block[2]);
      const auto outer = hn::Add(hn::Add(rows_of_block[0], rows_of_block[4]), rows_of_block[2]);
      const auto times_9 = hn::Add(hn::ShiftLeft<3>(rows_of_block[2]), rows_of_block[2]);
      const auto ring_1 = hn::Sub(hn::Sub(times_9, inner), hn::Add(previous_inner, previous_outer));
      const auto ring_2 = hn::Sub(hn::Sub(times_9, outer), hn::Add(previous_outer, previous_whole));
      textures = hn::Add(textures, texture_of_rings(ring_1, ring_2, order, false));
      textures = hn::Add(textures, texture_of_rings(ring_1, ring_2, order, true));
      previous_inner = ring_2;
      previous_outer = ring_1;
    }
    // The filters have coefficients a + b sqrt(3): "whole" sums use a, and "root" sums use b.
    const auto outer_sum = hn::Add(x0, x3);
    const auto inner_sum = hn::Add(x1, x2);
    const auto outer_difference = hn::Sub(x0, x3);
    const auto inner_difference = hn::Sub(x1, x2);
    const auto low_whole = hn::Add(outer_sum, triple(inner_sum));
    const auto low_root = hn::Add(outer_difference, inner_difference);
    const auto high_whole = hn::Sub(outer_difference, triple(inner_difference));
    const auto high_root = hn::Sub(inner_sum, outer_sum);
    const auto ll = band_of(low_whole, low_root, previous_whole, previous_root, low);
    const auto hl = band_of(low_whole, low_root, previous_whole, previous_root, high);
    const auto lh = band_of(high_whole, high_root, previous_whole, previous_root, low);
    const auto hh = band_of(high_whole, high_root, previous_whole, previous_root, high);
    bands = hn::Add(bands, hn::Xor(hn::Xor(ll, hl), hn::Xor(lh, hh)));
    previous_whole = hn::Xor(low_whole, previous_inner);
    previous_root = hn::Xor(high_root, previous_outer);
    order = hn::Max(order, hn::Mul(textures, hn::Set(d, 1e-9F)));
    // Makes the sums differ between iterations.
    hn::Store(hn::Xor(x0, x4), shorts, rows[i / (2 * kBlock) % 2]);
  }
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(textures, hn::ConvertTo(d, bands))));
}
#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::bench {
HWY_EXPORT(copy);
HWY_EXPORT(arithmetic);

void stream(std::span<const std::uint8_t> bytes, std::span<float> samples, WriteMode mode) {
  HWY_DYNAMIC_DISPATCH(copy)
  (bytes.data(), samples.data(), samples.size(), mode == WriteMode::past_caches);
}

float texture_arithmetic(std::size_t pixels) {
  return HWY_DYNAMIC_DISPATCH(arithmetic)(pixels);
}

}  // namespace touchtrial::bench
#endif

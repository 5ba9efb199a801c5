#include "bench/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Compiled once for every target: this file includes itself.
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

/// Whole vectors from the first address that is a multiple of a cache line on.
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

/// A ring's difference is a sum over its neighbours and the centre. Horner's rule combines two of
/// them, with an order for each pixel, to the texture.
HWY_INLINE Real rings_of(Short ring_1, Short ring_2, Real order, bool upper) {
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

/// A weighted sum of four neighbours of two kinds, as the exact sub-bands need.
HWY_INLINE Long band_of(Short a, Short b, Short c, Short e, Short weights) {
  const Longs wide;
  auto sum = hn::Zero(wide);
  auto other = hn::Zero(wide);
  for (const Short v : {a, b, c, e}) {
    sum = hn::ReorderWidenMulAccumulate(wide, v, weights, sum, other);
  }
  return hn::RearrangeToOddPlusEven(sum, other);
}

HWY_INLINE Short tripled(Short v) {
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
  auto inner_before = hn::Load(shorts, rows[6]);
  auto outer_before = hn::Load(shorts, rows[7]);
  auto whole_before = hn::Load(shorts, rows[7]);
  auto root_before = whole_before;
  const auto low = hn::Set(shorts, 97);
  const auto high = hn::Set(shorts, 61);
  for (std::size_t i = 0; i < pixels; i += 2 * kBlock) {
    // Two rows of a block share the sub-bands' filter, and each has rings of its own.
    const auto x0 = hn::Load(shorts, rows[0]);
    const auto x1 = hn::Load(shorts, rows[1]);
    const auto x2 = hn::Load(shorts, rows[2]);
    const auto x3 = hn::Load(shorts, rows[3]);
    const auto x4 = hn::Load(shorts, rows[4]);
    const auto x5 = hn::Load(shorts, rows[5]);
    for (const auto& near : {std::array{x0, x1, x2, x3, x4}, std::array{x1, x2, x3, x4, x5}}) {
      const auto inner = hn::Add(hn::Add(near[1], near[3]), near[2]);
      const auto outer = hn::Add(hn::Add(near[0], near[4]), near[2]);
      const auto nine = hn::Add(hn::ShiftLeft<3>(near[2]), near[2]);
      const auto ring_1 = hn::Sub(hn::Sub(nine, inner), hn::Add(inner_before, outer_before));
      const auto ring_2 = hn::Sub(hn::Sub(nine, outer), hn::Add(outer_before, whole_before));
      textures = hn::Add(textures, rings_of(ring_1, ring_2, order, false));
      textures = hn::Add(textures, rings_of(ring_1, ring_2, order, true));
      inner_before = ring_2;
      outer_before = ring_1;
    }
    const auto outer_sum = hn::Add(x0, x3);
    const auto inner_sum = hn::Add(x1, x2);
    const auto outer_difference = hn::Sub(x0, x3);
    const auto inner_difference = hn::Sub(x1, x2);
    const auto low_whole = hn::Add(outer_sum, tripled(inner_sum));
    const auto low_root = hn::Add(outer_difference, inner_difference);
    const auto high_whole = hn::Sub(outer_difference, tripled(inner_difference));
    const auto high_root = hn::Sub(inner_sum, outer_sum);
    const auto ll = band_of(low_whole, low_root, whole_before, root_before, low);
    const auto hl = band_of(low_whole, low_root, whole_before, root_before, high);
    const auto lh = band_of(high_whole, high_root, whole_before, root_before, low);
    const auto hh = band_of(high_whole, high_root, whole_before, root_before, high);
    bands = hn::Add(bands, hn::Xor(hn::Xor(ll, hl), hn::Xor(lh, hh)));
    whole_before = hn::Xor(low_whole, inner_before);
    root_before = hn::Xor(high_root, outer_before);
    order = hn::Max(order, hn::Mul(textures, hn::Set(d, 1e-9F)));
    // Makes the sums differ between turns.
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

void stream(std::span<const std::uint8_t> bytes, std::span<float> samples, Writing how) {
  HWY_DYNAMIC_DISPATCH(copy)
  (bytes.data(), samples.data(), samples.size(), how == Writing::past_caches);
}

float texture_arithmetic(std::size_t pixels) {
  return HWY_DYNAMIC_DISPATCH(arithmetic)(pixels);
}

}  // namespace touchtrial::bench
#endif

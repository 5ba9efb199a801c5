#include "engine/kernels/wavelet_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/wavelet_rows.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/real_pairs-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace touchtrial {
namespace HWY_NAMESPACE {
namespace {

/// Both parts of one filter's output.
struct Parts {
  Integer whole;
  Integer root;
};

struct FilteredParts {
  Parts low;
  Parts high;
};

HWY_INLINE Integer tripled(Integer v) {
  return hn::Add(hn::Add(v, v), v);
}

/// Both filters on four neighbouring samples that are whole numbers.
HWY_INLINE FilteredParts filtered(Integer x0, Integer x1, Integer x2, Integer x3) {
  const auto outer_sum = hn::Add(x0, x3);
  const auto inner_sum = hn::Add(x1, x2);
  const auto outer_difference = hn::Sub(x0, x3);
  const auto inner_difference = hn::Sub(x1, x2);
  return {{hn::Add(outer_sum, tripled(inner_sum)), hn::Add(outer_difference, inner_difference)},
          {hn::Sub(outer_difference, tripled(inner_difference)), hn::Sub(inner_sum, outer_sum)}};
}

/// Samples at even and at odd places of 2 * kBlock bytes.
struct EvenOdd {
  Integer even;
  Integer odd;
};

HWY_INLINE EvenOdd load_even_odd(const std::uint8_t* from) {
  const Integers d;
#if HWY_TARGET == HWY_SCALAR
  return {hn::Set(d, from[0]), hn::Set(d, from[1])};
#else
  const hn::RebindToUnsigned<Integers> words;
  const hn::Repartition<std::uint8_t, Integers> bytes;
  const auto both = hn::BitCast(words, hn::LoadU(bytes, from));  // little-endian: even ones low
  return {hn::BitCast(d, hn::And(both, hn::Set(words, 255))),
          hn::BitCast(d, hn::ShiftRight<8>(both))};
#endif
}

HWY_INLINE void store(Parts parts, RootRow to, int i) {
  hn::StoreU(parts.whole, Integers(), to.whole + i);
  hn::StoreU(parts.root, Integers(), to.root + i);
}

void along_x(const std::uint8_t* row, int count, const LowHigh& out) {
  for (int i = 0; i < count; i += kBlock) {
    const EvenOdd left = load_even_odd(row + 2 * i);
    const EvenOdd right = load_even_odd(row + 2 * i + 2);
    const FilteredParts parts = filtered(left.even, left.odd, right.even, right.odd);
    store(parts.low, out.low, i);
    store(parts.high, out.high, i);
  }
}

/// (p + q s)(whole + root s), where `whole` and `root` hold the filters p + q s of the parts.
HWY_INLINE Parts product(Parts whole, Parts root) {
  return {hn::ShiftRight<1>(hn::Add(whole.whole, tripled(root.root))),
          hn::ShiftRight<1>(hn::Add(whole.root, root.whole))};
}

HWY_INLINE FilteredParts filtered_part(const std::array<RootRow, 4>& rows,
                                       std::int16_t* RootRow::*part, int i) {
  const Integers d;
  return filtered(hn::LoadU(d, rows[0].*part + i), hn::LoadU(d, rows[1].*part + i),
                  hn::LoadU(d, rows[2].*part + i), hn::LoadU(d, rows[3].*part + i));
}

HWY_INLINE FilteredParts products(const std::array<RootRow, 4>& rows, int i) {
  const FilteredParts whole = filtered_part(rows, &RootRow::whole, i);
  const FilteredParts root = filtered_part(rows, &RootRow::root, i);
  return {product(whole.low, root.low), product(whole.high, root.high)};
}

void along_y(const std::array<RootRow, 4>& rows, int count, const LowHigh& out) {
  for (int i = 0; i < count; i += kBlock) {
    const FilteredParts parts = products(rows, i);
    store(parts.low, out.low, i);
    store(parts.high, out.high, i);
  }
}

HWY_INLINE Real value(Real whole, Real root) {
  const Reals d;
  const auto scale = hn::Set(d, kWaveletScale);
  const auto root3 = hn::Set(d, std::numbers::sqrt3_v<float>);
  return hn::Mul(hn::MulAdd(root3, root, whole), scale);
}

HWY_INLINE RealPair values_of(Parts parts) {
  const RealPair whole = to_reals(parts.whole);
  const RealPair root = to_reals(parts.root);
  return {value(whole.lower, root.lower), value(whole.upper, root.upper)};
}

HWY_INLINE void store_some(RealPair pair, int count, float* to) {
  alignas(64) float all[kBlock];
  store_pair(pair, all);
  std::copy_n(all, count, to);
}

void values(RootRow row, int count, float* out) {
  const Integers d;
  int i = 0;
  for (; i + kBlock <= count; i += kBlock) {
    store_pair(values_of({hn::LoadU(d, row.whole + i), hn::LoadU(d, row.root + i)}), out + i);
  }
  if (i == count) return;
  const Parts rest{hn::LoadU(d, row.whole + i), hn::LoadU(d, row.root + i)};
  store_some(values_of(rest), count - i, out + i);
}

void values_along_y(const std::array<RootRow, 4>& rows, int count, float* low, float* high) {
  int i = 0;
  for (; i + kBlock <= count; i += kBlock) {
    const FilteredParts parts = products(rows, i);
    store_pair(values_of(parts.low), low + i);
    store_pair(values_of(parts.high), high + i);
  }
  if (i == count) return;
  const FilteredParts rest = products(rows, i);
  store_some(values_of(rest.low), count - i, low + i);
  store_some(values_of(rest.high), count - i, high + i);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial {
namespace {

HWY_EXPORT(along_x);
HWY_EXPORT(along_y);
HWY_EXPORT(values);
HWY_EXPORT(values_along_y);

}  // namespace

void filter_along_x(const std::uint8_t* row, int count, const LowHigh& out) {
  HWY_DYNAMIC_DISPATCH(along_x)(row, count, out);
}

void filter_along_y(const std::array<RootRow, 4>& rows, int count, const LowHigh& out) {
  HWY_DYNAMIC_DISPATCH(along_y)(rows, count, out);
}

void filter_along_y(const std::array<RootRow, 4>& rows, int count, float* low, float* high) {
  HWY_DYNAMIC_DISPATCH(values_along_y)(rows, count, low, high);
}

void sub_band_values(RootRow row, int count, float* out) {
  HWY_DYNAMIC_DISPATCH(values)(row, count, out);
}

}  // namespace touchtrial
#endif

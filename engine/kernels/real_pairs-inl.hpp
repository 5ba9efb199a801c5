/// \file Conversion of 16-bit integers to floats, for one target: one vector of integers becomes a
/// pair of vectors of floats. The target with one lane uses only the lower vector of a pair.
// Included once for every target by the kernels.
#if defined(TOUCHTRIAL_REAL_PAIRS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TOUCHTRIAL_REAL_PAIRS_INL
#undef TOUCHTRIAL_REAL_PAIRS_INL
#else
#define TOUCHTRIAL_REAL_PAIRS_INL
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Reals = hn::ScalableTag<float>;
using WideIntegers = hn::RebindToSigned<Reals>;
#if HWY_TARGET == HWY_SCALAR
using Integers = hn::Rebind<std::int16_t, Reals>;
#else
using Integers = hn::Repartition<std::int16_t, Reals>;
#endif
using Real = hn::Vec<Reals>;
using Integer = hn::Vec<Integers>;

/// The number of integers in a vector: the length of a block of samples in the kernels.
constexpr int kBlock = static_cast<int>(hn::MaxLanes(Integers()));

struct RealPair {
  Real lower;
  Real upper;
};

/// Converts integers to floats, exactly.
HWY_INLINE RealPair to_reals(Integer v) {
  const Reals d;
  const WideIntegers wide;
#if HWY_TARGET == HWY_SCALAR
  return {hn::ConvertTo(d, hn::PromoteTo(wide, v)), hn::Zero(d)};
#else
  const hn::Half<Integers> half;
  return {hn::ConvertTo(d, hn::PromoteTo(wide, hn::LowerHalf(half, v))),
          hn::ConvertTo(d, hn::PromoteTo(wide, hn::UpperHalf(half, v)))};
#endif
}

HWY_INLINE RealPair load_pair(const float* source) {
  const Reals d;
#if HWY_TARGET == HWY_SCALAR
  return {hn::LoadU(d, source), hn::Zero(d)};
#else
  return {hn::LoadU(d, source), hn::LoadU(d, source + hn::Lanes(d))};
#endif
}

HWY_INLINE void store_pair(RealPair pair, float* target) {
  const Reals d;
  hn::StoreU(pair.lower, d, target);
#if HWY_TARGET != HWY_SCALAR
  hn::StoreU(pair.upper, d, target + hn::Lanes(d));
#endif
}

/// Loads kBlock bytes as integers.
HWY_INLINE Integer load_bytes(const std::uint8_t* source) {
  return hn::PromoteTo(Integers(), hn::LoadU(hn::Rebind<std::uint8_t, Integers>(), source));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#endif

#include "engine/kernels/texture_rows.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/texture_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Rounds half up, without adding 0.5 to the sample, because that sum would be rounded.
template <class D>
HWY_INLINE void store_picture(D d, const float* texture, std::uint8_t* picture) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const hn::RebindToSigned<D> integers;
  const auto sample = hn::LoadU(d, texture);
  const auto lowest = hn::Set(d, -128.0F);
  const auto t = hn::IfThenElse(hn::Eq(sample, sample), sample, lowest);
  const auto floor = hn::Floor(t);
  const auto rounds_up = hn::Ge(hn::Sub(t, floor), hn::Set(d, 0.5F));  // false for infinities
  const auto rounded = hn::Add(floor, hn::IfThenElseZero(rounds_up, hn::Set(d, 1.0F)));
  const auto level = hn::Min(hn::Max(rounded, lowest), hn::Set(d, 127.0F));
  const auto grey = hn::Add(hn::ConvertTo(integers, level), hn::Set(integers, 128));
  hn::StoreU(hn::DemoteTo(bytes, grey), bytes, picture);
}

void row_of_picture(const float* texture, int width, std::uint8_t* picture) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + lanes <= width; x += lanes) store_picture(d, texture + x, picture + x);
  const hn::CappedTag<float, 1> single;
  for (; x < width; ++x) store_picture(single, texture + x, picture + x);
}

/// Compares bit patterns, which sort like integers after the bits of negative floats are inverted.
float highest_of_samples(const float* samples, std::size_t count) {
  const hn::ScalableTag<std::int32_t> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto magnitude = hn::Set(d, 0x7fffffff);
  const hn::RebindToFloat<decltype(d)> reals;
  auto highest = hn::Set(d, std::numeric_limits<std::int32_t>::min());
  auto largest = hn::Zero(d);
  std::size_t i = 0;
  const auto include = [&](auto v) HWY_ATTR {
    highest = hn::Max(highest, hn::Xor(v, hn::And(hn::ShiftRight<31>(v), magnitude)));
    largest = hn::Max(largest, hn::And(v, magnitude));
  };
  for (; i + lanes <= count; i += lanes) include(hn::BitCast(d, hn::LoadU(reals, samples + i)));
  for (; i < count; ++i) include(hn::Set(d, std::bit_cast<std::int32_t>(samples[i])));
  const std::int32_t largest_bits = hn::GetLane(hn::MaxOfLanes(d, largest));
  const std::int32_t highest_bits = hn::GetLane(hn::MaxOfLanes(d, highest));
  constexpr std::int32_t kInfinite = 0x7f800000;
  return std::bit_cast<float>(largest_bits >= kInfinite
                                  ? largest_bits
                                  : highest_bits ^ ((highest_bits >> 31) & 0x7fffffff));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
HWY_EXPORT(row_of_picture);
HWY_EXPORT(highest_of_samples);

void picture_row(const float* texture, int width, std::uint8_t* picture) {
  HWY_DYNAMIC_DISPATCH(row_of_picture)(texture, width, picture);
}

float highest_sample(std::span<const float> samples) {
  return HWY_DYNAMIC_DISPATCH(highest_of_samples)(samples.data(), samples.size());
}

}  // namespace touchtrial::engine
#endif

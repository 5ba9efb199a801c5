#include "engine/kernels/field_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/field_rows.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace touchtrial {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Rounds half up without adding a half first, which would round on to ties.
template <class D>
HWY_INLINE void picture_at(D d, const float* texture, std::uint8_t* picture) {
  const hn::Rebind<std::uint8_t, D> bytes;
  const hn::RebindToSigned<D> integers;
  const auto any = hn::LoadU(d, texture);
  const auto lowest = hn::Set(d, -128.0F);
  const auto t = hn::IfThenElse(hn::Eq(any, any), any, lowest);
  const auto floor = hn::Floor(t);
  const auto upwards = hn::Ge(hn::Sub(t, floor), hn::Set(d, 0.5F));  // false for infinities
  const auto rounded = hn::Add(floor, hn::IfThenElseZero(upwards, hn::Set(d, 1.0F)));
  const auto level = hn::Min(hn::Max(rounded, lowest), hn::Set(d, 127.0F));
  const auto grey = hn::Add(hn::ConvertTo(integers, level), hn::Set(integers, 128));
  hn::StoreU(hn::DemoteTo(bytes, grey), bytes, picture);
}

void row_of_picture(const float* texture, int width, std::uint8_t* picture) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + lanes <= width; x += lanes) picture_at(d, texture + x, picture + x);
  const hn::CappedTag<float, 1> one;
  for (; x < width; ++x) picture_at(one, texture + x, picture + x);
}

/// Where all eight neighbours exist; each difference of opposite neighbours comes first, so that
/// equal ones cancel exactly.
template <class D>
HWY_INLINE void force_at(D d, const SurfaceRows& rows, int x, float* force_x, float* force_y) {
  const auto north_west = hn::LoadU(d, rows.above + x - 1);
  const auto north_east = hn::LoadU(d, rows.above + x + 1);
  const auto south_west = hn::LoadU(d, rows.below + x - 1);
  const auto south_east = hn::LoadU(d, rows.below + x + 1);
  const auto across = hn::Sub(hn::LoadU(d, rows.centre + x - 1), hn::LoadU(d, rows.centre + x + 1));
  const auto down = hn::Sub(hn::LoadU(d, rows.above + x), hn::LoadU(d, rows.below + x));
  const auto falling = hn::Sub(north_west, south_east);
  const auto rising = hn::Sub(south_west, north_east);
  const auto half = hn::Set(d, 0.5F);
  hn::StoreU(hn::MulAdd(half, hn::Add(falling, rising), across), d, force_x + x);
  hn::StoreU(hn::MulAdd(half, hn::Sub(falling, rising), down), d, force_y + x);
}

void inner_row_of_force(const SurfaceRows& rows, int width, float* force_x, float* force_y) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int x = 1;
  for (; x + lanes < width; x += lanes) force_at(d, rows, x, force_x, force_y);
  const hn::CappedTag<float, 1> one;
  for (; x + 1 < width; ++x) force_at(one, rows, x, force_x, force_y);
}

void row_of_stream(const float* from, int width, float* to) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto bytes_in_vector = static_cast<std::uintptr_t>(lanes) * sizeof(float);
  int x = 0;
  while (x < width && reinterpret_cast<std::uintptr_t>(to + x) % bytes_in_vector != 0) {
    to[x] = from[x];
    ++x;
  }
  for (; x + lanes <= width; x += lanes) hn::Stream(hn::LoadU(d, from + x), d, to + x);
  std::copy(from + x, from + width, to + x);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial {
namespace {

HWY_EXPORT(row_of_picture);
HWY_EXPORT(inner_row_of_force);
HWY_EXPORT(row_of_stream);

/// One pixel of a row that lacks neighbours.
void edge_force(const SurfaceRows& rows, int width, int x, float* force_x, float* force_y) {
  const float here = rows.centre[x];
  float sum_x = 0.0F;
  float sum_y = 0.0F;
  const float* const around[3] = {rows.above, rows.centre, rows.below};
  for (int dy = -1; dy <= 1; ++dy) {
    const float* const row = around[dy + 1];
    for (int dx = -1; row != nullptr && dx <= 1; ++dx) {
      if (x + dx < 0 || x + dx >= width) continue;
      const float share = (here - row[x + dx]) * (dx != 0 && dy != 0 ? 0.5F : 1.0F);
      sum_x += share * static_cast<float>(dx);
      sum_y += share * static_cast<float>(dy);
    }
  }
  force_x[x] = sum_x;
  force_y[x] = sum_y;
}

}  // namespace

void picture_row(const float* texture, int width, std::uint8_t* picture) {
  HWY_DYNAMIC_DISPATCH(row_of_picture)(texture, width, picture);
}

void force_row(const SurfaceRows& rows, int width, float* force_x, float* force_y) {
  if (rows.above == nullptr || rows.below == nullptr) {
    for (int x = 0; x < width; ++x) edge_force(rows, width, x, force_x, force_y);
    return;
  }
  HWY_DYNAMIC_DISPATCH(inner_row_of_force)(rows, width, force_x, force_y);
  edge_force(rows, width, 0, force_x, force_y);
  edge_force(rows, width, width - 1, force_x, force_y);
}

void stream_row(const float* from, int width, float* to) {
  HWY_DYNAMIC_DISPATCH(row_of_stream)(from, width, to);
}

void finish_streams() {
  hwy::FlushStream();
}

}  // namespace touchtrial
#endif

#include "engine/kernels/field_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/field_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next one is compiled for the target that those two have set.
#include "engine/kernels/streamed_row-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Slopes = ForceRows::Slopes;

/// Rounds half up. It does not add a half first, as that would round to ties.
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

/// Takes the differences of opposite neighbours first, so that equal ones cancel exactly.
template <class D>
HWY_INLINE void force_at(D d, const float* surface, const Slopes& above, const Slopes& centre,
                         const Slopes& below, int x, float* force_x, float* force_y) {
  const auto half = hn::Set(d, 0.5F);
  const auto left = hn::LoadU(d, surface + x - 1);
  const auto right = hn::LoadU(d, surface + x + 1);
  const auto across = hn::Sub(left, right);
  const auto weight = hn::MulAdd(half, hn::Add(left, right), hn::LoadU(d, surface + x));
  const auto beside = hn::Add(hn::LoadU(d, above.across + x), across);
  hn::StoreU(across, d, below.across + x);
  hn::StoreU(weight, d, below.weight + x);
  hn::StoreU(hn::MulAdd(half, beside, hn::LoadU(d, centre.across + x)), d, force_x + x);
  hn::StoreU(hn::Sub(hn::LoadU(d, above.weight + x), weight), d, force_y + x);
}

/// Takes a row of a surface and gives the force of the row above it:
/// x = across + (across above + across below) / 2, y = weight above - weight below.
/// \param surface  `width` samples, with a 0 at both ends
/// \param above,centre  slopes of the two rows above the surface
/// \param below  receives the slopes of the surface; a vector behind them may be overwritten
/// \param force_x,force_y  receive `width` samples and no more
/// \param beside  a row of at most `width` samples to move meanwhile
void row_of_force(const float* surface, int width, const Slopes& above, const Slopes& centre,
                  const Slopes& below, float* force_x, float* force_y, const StreamedRow& beside) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    move_samples(beside, x, lanes);
    force_at(d, surface, above, centre, below, x, force_x, force_y);
  }
  if (x < width && width >= lanes) {  // the last block overlaps the one before it
    x = width;
    force_at(d, surface, above, centre, below, width - lanes, force_x, force_y);
  }
  const hn::CappedTag<float, 1> one;
  for (; x < width; ++x) force_at(one, surface, above, centre, below, x, force_x, force_y);
}

void all_of_row(const StreamedRow& row) {
  move_samples(row, 0, row.count);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
namespace {

HWY_EXPORT(row_of_picture);
HWY_EXPORT(row_of_force);
HWY_EXPORT(all_of_row);

}  // namespace

void picture_row(const float* texture, int width, std::uint8_t* picture) {
  HWY_DYNAMIC_DISPATCH(row_of_picture)(texture, width, picture);
}

void move_row(const StreamedRow& row) {
  HWY_DYNAMIC_DISPATCH(all_of_row)(row);
}

ForceRows::ForceRows(int width)
    : width_(width),
      samples_(3 * kRows, static_cast<std::size_t>(width), kVectorBytes / sizeof(float)) {
  for (std::size_t row = 0; row < kRows; ++row) {
    slopes_[row] = {samples_.row(kRows + 2 * row), samples_.row(kRows + 2 * row + 1)};
  }
}

void ForceRows::add_row(float* force_x, float* force_y, const StreamedRow& beside) {
  float* const surface = surface_row(rows_);
  surface[-1] = 0.0F;
  surface[width_] = 0.0F;
  HWY_DYNAMIC_DISPATCH(row_of_force)
  (surface, width_, slopes(rows_ - 2), slopes(rows_ - 1), slopes(rows_), force_x, force_y, beside);
  if (rows_ == 0) {
    fill_border(surface, slopes(-1));
  } else {
    correct_ends(rows_ - 1, false, force_x);
  }
  ++rows_;
}

void ForceRows::finish(float* force_x, float* force_y) {
  const int last = rows_ - 1;
  fill_border(surface_row(last), slopes(rows_));
  for (int x = 0; x < width_; ++x) {
    force_x[x] = slopes(last).across[x] + 0.5F * slopes(last - 1).across[x];
    force_y[x] = slopes(last - 1).weight[x] - slopes(rows_).weight[x];
  }
  correct_ends(last, true, force_x);
}

/// Writes the slopes of a row outside the image. With them, only existing neighbours affect the row
/// at the border.
void ForceRows::fill_border(const float* surface, const Slopes& out) const {
  std::fill_n(out.across, width_, 0.0F);
  for (int x = 0; x < width_; ++x) out.weight[x] = 2.0F * surface[x];
  out.weight[0] -= 0.5F * surface[0];
  out.weight[width_ - 1] -= 0.5F * surface[width_ - 1];
}

/// Corrects the force of the first and the last pixel of a row for their missing neighbours.
void ForceRows::correct_ends(int row, bool last, float* force_x) {
  const float beside = 2.0F - (row == 0 ? 0.5F : 0.0F) - (last ? 0.5F : 0.0F);
  const float* const surface = surface_row(row);
  force_x[0] += beside * surface[0];
  force_x[width_ - 1] -= beside * surface[width_ - 1];
}

}  // namespace touchtrial::engine
#endif

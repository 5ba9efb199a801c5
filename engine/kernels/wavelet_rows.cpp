#include "engine/kernels/wavelet_rows.hpp"

#include "engine/kernels/rows_ahead.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cstddef>

// Compiled once for every target: this file includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/kernels/wavelet_rows.cpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format off: the next header is compiled for the target selected above.
#include "engine/kernels/sub_band_blocks-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace touchtrial::engine {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Integer triple(Integer v) {
  return hn::Add(hn::Add(v, v), v);
}

/// Filters a block of the four rows from column `x`, and writes it to the outputs from column
/// `out_x`.
HWY_INLINE void filter_block(const std::array<const std::uint8_t*, 4>& rows, int x,
                             const FilteredRows& out, int out_x) {
  const Integers d;
  const auto x0 = load_bytes(rows[0] + x);
  const auto x1 = load_bytes(rows[1] + x);
  const auto x2 = load_bytes(rows[2] + x);
  const auto x3 = load_bytes(rows[3] + x);
  const auto outer_sum = hn::Add(x0, x3);
  const auto inner_sum = hn::Add(x1, x2);
  const auto outer_difference = hn::Sub(x0, x3);
  const auto inner_difference = hn::Sub(x1, x2);
  hn::StoreU(hn::Add(outer_sum, triple(inner_sum)), d, out.low_whole + out_x);
  hn::StoreU(hn::Add(outer_difference, inner_difference), d, out.low_root + out_x);
  hn::StoreU(hn::Sub(outer_difference, triple(inner_difference)), d, out.high_whole + out_x);
  hn::StoreU(hn::Sub(inner_sum, outer_sum), d, out.high_root + out_x);
}

/// \param width  >= 1; exactly this many samples are read
/// \param out  receives `width` samples each; a vector after them may be overwritten
void filter_along_y(const std::array<const std::uint8_t*, 4>& rows, int width,
                    const FilteredRows& out) {
  int x = 0;
  for (; x + kBlock <= width; x += kBlock) filter_block(rows, x, out, x);
  if (x == width) return;
  if (width >= kBlock) {
    filter_block(rows, width - kBlock, out, width - kBlock);
    return;
  }
  std::uint8_t copies[4][kBlock] = {};
  for (std::size_t m = 0; m < 4; ++m) std::copy_n(rows[m], width, copies[m]);
  filter_block({copies[0], copies[1], copies[2], copies[3]}, 0, out, 0);
}

void store_values_block(const FilteredRows& rows, int i, const BandRows<float>& out, int out_x) {
  const Reals d;
  for_each_band(rows, i, [&](std::size_t band, WideInteger block) HWY_ATTR {
    hn::StoreU(hn::Mul(hn::ConvertTo(d, block), hn::Set(d, kWaveletScale)), d, out[band] + out_x);
  });
}

void store_values(const FilteredRows& rows, int count, const BandRows<float>& out) {
  int i = 0;
  for (; i + kHalfBlock <= count; i += kHalfBlock) store_values_block(rows, i, out, i);
  if (i == count) return;
  if (count >= kHalfBlock) {
    store_values_block(rows, count - kHalfBlock, out, count - kHalfBlock);
    return;
  }
  float blocks[4][kHalfBlock];
  store_values_block(rows, 0, {blocks[0], blocks[1], blocks[2], blocks[3]}, 0);
  for (std::size_t band = 0; band < 4; ++band) std::copy_n(blocks[band], count, out[band]);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace touchtrial::engine
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace touchtrial::engine {
HWY_EXPORT(filter_along_y);
HWY_EXPORT(store_values);

ColumnFilter::ColumnFilter(const GreyImage& image, Columns columns)
    : image_(image),
      first_x_(2 * columns.first),
      image_width_(std::min(2 * columns.count() + 2, image.width() - first_x_)),
      filtered_width_(2 * columns.count() + 2),
      samples_(4, static_cast<std::size_t>(filtered_width_), kVectorBytes / sizeof(std::int16_t)),
      rows_{samples_.row(0), samples_.row(1), samples_.row(2), samples_.row(3)} {}

const FilteredRows& ColumnFilter::row(int y) {
  std::array<const std::uint8_t*, 4> rows;
  for (int m = 0; m < 4; ++m) {
    rows[m] = image_.row(symmetric_index(2 * y + m, image_.height())).data() + first_x_;
  }
  for (int m = 4; m < 6; ++m) prefetch_row(image_, 2 * y + m, {first_x_, first_x_ + image_width_});
  HWY_DYNAMIC_DISPATCH(filter_along_y)(rows, image_width_, rows_);
  for (std::size_t part = 0; part < 4; ++part) extend(samples_.row(part));
  return rows_;
}

void ColumnFilter::extend(std::int16_t* row) const {
  for (int x = image_width_; x < filtered_width_; ++x) {
    row[x] = row[symmetric_index(first_x_ + x, image_.width()) - first_x_];
  }
}

void filter_along_x(const FilteredRows& rows, int count, const BandRows<float>& out) {
  HWY_DYNAMIC_DISPATCH(store_values)(rows, count, out);
}

}  // namespace touchtrial::engine
#endif

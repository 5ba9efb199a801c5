#include "engine/kernels/column_filter.hpp"

#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace touchtrial::engine {
namespace {

constexpr int kTaps = 4;
constexpr std::size_t kParts = 4;

}  // namespace

ColumnFilter::ColumnFilter(const GreyImage& image, Columns columns)
    : image_(image),
      first_x_(2 * columns.first),
      available_(std::min(2 * columns.count() + kTaps - 2, image.width() - first_x_)),
      wanted_(2 * columns.count() + kTaps - 2),
      samples_(kParts, static_cast<std::size_t>(wanted_), kVectorBytes / sizeof(std::int16_t)),
      rows_{samples_.row(0), samples_.row(1), samples_.row(2), samples_.row(3)} {}

const FilteredRows& ColumnFilter::row(int y) {
  std::array<const std::uint8_t*, kTaps> rows;
  for (int m = 0; m < kTaps; ++m) {
    rows[m] = image_.row(symmetric_index(2 * y + m, image_.height())).data() + first_x_;
  }
  filter_along_y(rows, available_, rows_);
  for (std::size_t part = 0; part < kParts; ++part) extend(samples_.row(part));
  return rows_;
}

void ColumnFilter::extend(std::int16_t* row) const {
  for (int x = available_; x < wanted_; ++x) {
    row[x] = row[symmetric_index(first_x_ + x, image_.width()) - first_x_];
  }
}

}  // namespace touchtrial::engine

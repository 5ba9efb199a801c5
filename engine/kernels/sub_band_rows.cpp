#include "engine/kernels/sub_band_rows.hpp"

#include "engine/kernels/extended_rows.hpp"
#include "engine/symmetric_extension.hpp"

#include <array>

namespace touchtrial {
namespace {

constexpr int kTaps = 4;
constexpr int kBands = 4;
constexpr int kBandRows = 3;
constexpr int kLow = 0;
constexpr int kHigh = 1;

/// Rows of `parts` numbers each: `part` of row y among the last `kept` ones.
RootRow root_row(AlignedRows<std::int16_t>& rows, int parts, int part, int y, int kept) {
  const auto first = static_cast<std::size_t>(2 * (y % kept * parts + part));
  return {rows.row(first), rows.row(first + 1)};
}

void mirror_ends(std::int16_t* row, int width) {
  row[-1] = row[0];
  row[width] = row[width - 1];
}

}  // namespace

SubBandRows::SubBandRows(const GreyImage& image)
    : image_(image),
      extended_(1, static_cast<std::size_t>(image.width()), kTaps),
      filtered_(2 * 2 * kTaps, static_cast<std::size_t>(width()), 0),
      bands_(2 * kBands * kBandRows, static_cast<std::size_t>(width()), 1) {
  filter_image_row(0);
  filter_image_row(1);
}

void SubBandRows::next_row() {
  advance();
  for (const int part : {kLow, kHigh}) {
    const bool low = part == kLow;
    const RootRow low_along_y = row(low ? SubBand::ll : SubBand::hl, y_);
    const RootRow high_along_y = row(low ? SubBand::lh : SubBand::hh, y_);
    filter_along_y(filtered_rows(part), width(), {low_along_y, high_along_y});
    for (const RootRow band : {low_along_y, high_along_y}) {
      mirror_ends(band.whole, width());
      mirror_ends(band.root, width());
    }
  }
}

void SubBandRows::next_row(const std::array<float*, 4>& to) {
  advance();
  const auto [ll, lh, hl, hh] = to;
  filter_along_y(filtered_rows(kLow), width(), ll, lh);
  filter_along_y(filtered_rows(kHigh), width(), hl, hh);
}

void SubBandRows::advance() {
  ++y_;
  filter_image_row(2 * y_ + 2);
  filter_image_row(2 * y_ + 3);
}

std::array<RootRow, 4> SubBandRows::filtered_rows(int part) noexcept {
  std::array<RootRow, kTaps> rows;
  for (int m = 0; m < kTaps; ++m) rows[m] = filtered_row(part, 2 * y_ + m);
  return rows;
}

RootRow SubBandRows::row(SubBand band, int y) noexcept {
  return root_row(bands_, kBands, static_cast<int>(band), y, kBandRows);
}

RootRow SubBandRows::filtered_row(int part, int y) noexcept {
  return root_row(filtered_, 2, part, y, kTaps);
}

void SubBandRows::filter_image_row(int y) {
  const auto from = image_.row(symmetric_index(y, image_.height()));
  extend_row(from.data(), image_.width(), 0, kTaps, extended_.row(0));
  filter_along_x(extended_.row(0), width(), {filtered_row(kLow, y), filtered_row(kHigh, y)});
}

}  // namespace touchtrial

#include "engine/daub4.hpp"

#include "engine/kernels/strips.hpp"
#include "engine/symmetric_extension.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr int kTaps = 4;
using Filter = std::array<double, kTaps>;

constexpr double kRoot3 = std::numbers::sqrt3;
constexpr double kScale = 1.0 / (4.0 * std::numbers::sqrt2);
constexpr Filter kLow = {(1.0 + kRoot3) * kScale, (3.0 + kRoot3) * kScale, (3.0 - kRoot3) * kScale,
                         (1.0 - kRoot3) * kScale};
constexpr Filter kHigh = {kLow[3], -kLow[2], kLow[1], -kLow[0]};

template <typename Sample>
using ImageRows = std::array<std::span<const Sample>, kTaps>;

/// Filters four rows along y into one row, and mirrors its right end to fill `out`.
template <typename Sample>
void filter_columns(const ImageRows<Sample>& rows, const Filter& filter, std::vector<double>& out) {
  const std::size_t width = rows[0].size();
  for (std::size_t x = 0; x < width; ++x) {
    out[x] = filter[0] * rows[0][x] + filter[1] * rows[1][x] + filter[2] * rows[2][x] +
             filter[3] * rows[3][x];
  }
  for (std::size_t x = width; x < out.size(); ++x) {
    out[x] = out[static_cast<std::size_t>(
        symmetric_index(static_cast<int>(x), static_cast<int>(width)))];
  }
}

/// Filters along x and downsamples by two.
void filter_row(const std::vector<double>& row, const Filter& filter, std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double* x = row.data() + 2 * i;
    out[i] = filter[0] * x[0] + filter[1] * x[1] + filter[2] * x[2] + filter[3] * x[3];
  }
}

template <typename Sample>
SubBands sub_bands_of(const Plane<Sample>& image) {
  if (image.empty()) throw std::invalid_argument("daub4_sub_bands: the image is empty");
  const int height = (image.height() + 1) / 2;
  const int width = (image.width() + 1) / 2;
  SubBands bands{Plane<double>(height, width), Plane<double>(height, width),
                 Plane<double>(height, width), Plane<double>(height, width)};
  for_each_strip(height, 4 * width, [&](Rows strip) {
    std::vector<double> low(2 * static_cast<std::size_t>(width) + kTaps - 2);
    std::vector<double> high(low.size());
    for (int i = strip.first; i < strip.last; ++i) {
      ImageRows<Sample> rows;
      for (int m = 0; m < kTaps; ++m) {
        rows[static_cast<std::size_t>(m)] = image.row(symmetric_index(2 * i + m, image.height()));
      }
      filter_columns(rows, kLow, low);
      filter_columns(rows, kHigh, high);
      filter_row(low, kLow, bands.ll.row(i));
      filter_row(low, kHigh, bands.hl.row(i));
      filter_row(high, kLow, bands.lh.row(i));
      filter_row(high, kHigh, bands.hh.row(i));
    }
  });
  return bands;
}

}  // namespace

SubBands daub4_sub_bands(const GreyImage& image) {
  return sub_bands_of(image);
}

SubBands daub4_sub_bands(const Plane<double>& ll) {
  return sub_bands_of(ll);
}

}  // namespace touchtrial::engine

#include "engine/metrics/glcm_counts.hpp"

namespace touchtrial::engine {
namespace {

/// Indices into a cell, as in kGlcmOffsets.
enum Direction : std::size_t { kRight, kRightUp, kUp, kLeftUp };

}  // namespace

GlcmCounts::GlcmCounts(const GreyImage& image)
    : cells_(static_cast<std::size_t>(kGreyLevels) * kGreyLevels) {
  if (image.empty()) return;
  count_first_row(image);
  for (int y = 1; y < image.height(); ++y) {
    count_row(image.row(y).data(), image.row(y - 1).data(), image.row(y).size());
  }
}

void GlcmCounts::count_first_row(const GreyImage& image) {
  const auto row = image.row(0);
  for (std::size_t x = 0; x + 1 < row.size(); ++x) {
    ++cells_[row[x] * std::size_t{kGreyLevels} + row[x + 1]][kRight];
  }
}

void GlcmCounts::count_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t width) {
  const auto cells_of = [this, row](std::size_t x) {
    return cells_.data() + row[x] * std::size_t{kGreyLevels};
  };
  ++cells_of(0)[above[0]][kUp];
  if (width == 1) return;
  ++cells_of(0)[row[1]][kRight];
  ++cells_of(0)[above[1]][kRightUp];
  for (std::size_t x = 1; x + 1 < width; ++x) {
    GlcmCell* const cells = cells_of(x);
    ++cells[row[x + 1]][kRight];
    ++cells[above[x + 1]][kRightUp];
    ++cells[above[x]][kUp];
    ++cells[above[x - 1]][kLeftUp];
  }
  const std::size_t last = width - 1;
  ++cells_of(last)[above[last]][kUp];
  ++cells_of(last)[above[last - 1]][kLeftUp];
}

}  // namespace touchtrial::engine

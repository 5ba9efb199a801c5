#include "engine/kernels/half_gradient.hpp"

#include "engine/kernels/csgv_row.hpp"

#include <algorithm>
#include <array>

namespace touchtrial {

void HalfGradient::compute(SubBandRows& bands, int y) {
  const int above = std::max(y - 1, 0);
  const int below = std::min(y + 1, height_ - 1);
  std::array<BandRows, 4> rows;
  auto to = rows.begin();
  for (const SubBand band : {SubBand::ll, SubBand::lh, SubBand::hl, SubBand::hh}) {
    *to++ = {bands.row(band, above), bands.row(band, y), bands.row(band, below)};
  }
  const float of_row = csgv_row(rows, width_, rows_.row(static_cast<std::size_t>(y)));
  largest_ = std::max(largest_, of_row);
}

}  // namespace touchtrial

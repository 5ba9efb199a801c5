#include "engine/kernels/force_rows.hpp"

#include <algorithm>

namespace touchtrial::engine {

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
  force_row(surface, width_, slopes(rows_ - 2), slopes(rows_ - 1), slopes(rows_), force_x, force_y,
            beside);
  if (rows_ == 0) {
    fill_border(surface, slopes(-1));
  } else {
    mend_ends(rows_ - 1, false, force_x);
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
  mend_ends(last, true, force_x);
}

/// The slopes of a row outside of the image, with which only neighbours that exist have an effect
/// on the row at its border.
void ForceRows::fill_border(const float* surface, const SlopeRow& out) const {
  std::fill_n(out.across, width_, 0.0F);
  for (int x = 0; x < width_; ++x) out.weight[x] = 2.0F * surface[x];
  out.weight[0] -= 0.5F * surface[0];
  out.weight[width_ - 1] -= 0.5F * surface[width_ - 1];
}

void ForceRows::mend_ends(int row, bool last, float* force_x) {
  const float beside = 2.0F - (row == 0 ? 0.5F : 0.0F) - (last ? 0.5F : 0.0F);
  const float* const surface = surface_row(row);
  force_x[0] += beside * surface[0];
  force_x[width_ - 1] -= beside * surface[width_ - 1];
}

}  // namespace touchtrial::engine

#include "engine/kernels/half_gradient.hpp"

#include "engine/kernels/csgv_row.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cstdint>

namespace touchtrial::engine {
namespace {

/// The image is worked on in strips of columns, so that the rows kept stay in the first-level
/// cache.
constexpr int kStripColumns = 512;

constexpr std::size_t kVectorSamples = kVectorBytes / sizeof(std::int32_t);

/// The rolling rows of one strip.
class SobelState {
 public:
  explicit SobelState(int columns)
      : samples_(16, static_cast<std::size_t>(columns), kVectorSamples) {
    std::size_t next = 0;
    for (auto* kind : {&rows_.last, &rows_.pairs, &rows_.smoothed, &rows_.difference}) {
      for (std::int32_t*& row : *kind) row = samples_.row(next++);
    }
  }

  [[nodiscard]] const SobelRows& rows() const noexcept { return rows_; }

  /// Continues what a gradient is taken of by one sample to both sides.
  void mirror_ends(int columns) const {
    for (const auto& bands : {rows_.smoothed, rows_.difference}) {
      for (std::int32_t* const row : bands) {
        row[-1] = row[0];
        row[columns] = row[columns - 1];
      }
    }
  }

 private:
  AlignedRows<std::int32_t> samples_;
  SobelRows rows_;
};

}  // namespace

HalfGradient::HalfGradient(const GreyImage& image)
    : height_((image.height() + 1) / 2),
      width_((image.width() + 1) / 2),
      rows_(static_cast<std::size_t>(height_), static_cast<std::size_t>(width_), 0, RowUse::plane) {
  const int strips = (width_ + kStripColumns - 1) / kStripColumns;
  int first = 0;
  for (int strip = 1; strip <= strips; ++strip) {
    const int last = strip == strips ? width_ : first + width_ / strips;
    compute(image, {first, last});
    first = last;
  }
}

void HalfGradient::compute(const GreyImage& image, Columns columns) {
  const Columns wider{std::max(columns.first - 1, 0), std::min(columns.last + 1, width_)};
  ColumnFilter filter(image, wider);
  const SobelState state(wider.count());
  for (int y = -1; y <= height_; ++y) {
    filter_along_x(filter.row(symmetric_index(y, height_)), wider.count(), state.rows());
    if (y < 1) continue;
    state.mirror_ends(wider.count());
    float* const to = rows_.row(static_cast<std::size_t>(y - 1)) + columns.first;
    const float of_row = csgv_row(state.rows(), columns.first - wider.first, columns.count(), to);
    largest_ = std::max(largest_, of_row);
  }
}

}  // namespace touchtrial::engine

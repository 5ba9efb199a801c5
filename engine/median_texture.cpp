#include "engine/cited_textures.hpp"
#include "engine/symmetric_extension.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchtrial {
namespace {

/// The samples of a window as a histogram whose median follows them: from pixel to pixel it moves
/// by a few levels only.
class WindowHistogram {
 public:
  explicit WindowHistogram(std::int64_t samples) : rank_(samples / 2) {}

  void add(std::uint8_t level) noexcept {
    ++counts_[level];
    if (level < median_) ++below_;
  }
  void remove(std::uint8_t level) noexcept {
    --counts_[level];
    if (level < median_) --below_;
  }
  /// \pre the window is full
  [[nodiscard]] int median() noexcept {
    while (below_ > rank_) below_ -= counts_[--median_];
    while (below_ + counts_[median_] <= rank_) below_ += counts_[median_++];
    return static_cast<int>(median_);
  }

 private:
  std::array<std::int64_t, 256> counts_{};
  std::int64_t rank_;       ///< of the median among the samples, from 0
  std::size_t median_ = 0;  ///< a candidate
  std::int64_t below_ = 0;  ///< samples under the candidate
};

/// Rows y - radius .. y + radius of the extended image, by columns.
class WindowColumns {
 public:
  WindowColumns(const GreyImage& image, int radius)
      : image_(image), radius_(radius), rows_(static_cast<std::size_t>(2 * radius + 1)) {}

  void move_to_row(int y) {
    for (int dy = -radius_; dy <= radius_; ++dy) {
      rows_[static_cast<std::size_t>(dy + radius_)] =
          image_.row(symmetric_index(y + dy, image_.height())).data();
    }
  }
  template <typename Visit>
  void for_each_sample(int x, Visit visit) const {
    const int column = symmetric_index(x, image_.width());
    for (const std::uint8_t* row : rows_) visit(row[column]);
  }

 private:
  const GreyImage& image_;
  int radius_;
  std::vector<const std::uint8_t*> rows_;
};

}  // namespace

Plane<double> median_texture(const GreyImage& image, int radius, double threshold_grey) {
  Plane<double> texture(image.height(), image.width());
  WindowColumns columns(image, radius);
  const std::int64_t side = 2 * std::int64_t{radius} + 1;
  for (int y = 0; y < image.height(); ++y) {
    columns.move_to_row(y);
    WindowHistogram window(side * side);
    const auto enter = [&](int x) {
      columns.for_each_sample(x, [&](std::uint8_t level) { window.add(level); });
    };
    for (int x = -radius; x < radius; ++x) enter(x);
    for (int x = 0; x < image.width(); ++x) {
      enter(x + radius);
      const double difference = image.at(y, x) - window.median();
      if (std::abs(difference) > threshold_grey) texture.at(y, x) = difference;
      columns.for_each_sample(x - radius, [&](std::uint8_t level) { window.remove(level); });
    }
  }
  return texture;
}

}  // namespace touchtrial

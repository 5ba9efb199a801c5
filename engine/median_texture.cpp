#include "engine/cited_textures.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace touchtrial::engine {
namespace {

constexpr int kStripRows = 256;

/// The medians of a strip of rows. OpenCV's filter is exact, but repeats the last sample beyond the
/// edge: it gets the strip with its mirrored surroundings, and what it makes of those is left out.
class MedianStrip {
 public:
  MedianStrip(const GreyImage& image, int radius) : image_(image), radius_(radius) {}

  void move_to(int first_row, int rows) {
    framed_.create(rows + 2 * radius_, image_.width() + 2 * radius_, CV_8UC1);
    for (int y = 0; y < framed_.rows; ++y) {
      frame_row(image_.row(symmetric_index(first_row + y - radius_, image_.height())), y);
    }
    cv::medianBlur(framed_, medians_, 2 * radius_ + 1);
  }

  /// \param y  from 0 at the strip's first row
  [[nodiscard]] const std::uint8_t* row(int y) const {
    return medians_.ptr<std::uint8_t>(y + radius_) + radius_;
  }

 private:
  void frame_row(std::span<const std::uint8_t> from, int y) {
    std::uint8_t* const to = framed_.ptr<std::uint8_t>(y) + radius_;
    std::copy(from.begin(), from.end(), to);
    const int width = image_.width();
    for (int i = 1; i <= radius_; ++i) {
      to[-i] = from[static_cast<std::size_t>(symmetric_index(-i, width))];
      to[width - 1 + i] = from[static_cast<std::size_t>(symmetric_index(width - 1 + i, width))];
    }
  }

  const GreyImage& image_;
  int radius_;
  cv::Mat framed_;
  cv::Mat medians_;
};

}  // namespace

template <typename Real>
Plane<Real> median_texture(const GreyImage& image, int radius, double threshold_grey) {
  Plane<Real> texture(image.height(), image.width());
  MedianStrip strip(image, radius);
  for (int first = 0; first < image.height(); first += kStripRows) {
    const int rows = std::min(kStripRows, image.height() - first);
    strip.move_to(first, rows);
    for (int y = 0; y < rows; ++y) {
      const auto greys = image.row(first + y);
      std::transform(
          greys.begin(), greys.end(), strip.row(y), texture.row(first + y).begin(),
          [threshold_grey](std::uint8_t grey, std::uint8_t median) {
            const int difference = grey - median;
            return static_cast<Real>(std::abs(difference) > threshold_grey ? difference : 0);
          });
    }
  }
  return texture;
}

template Plane<float> median_texture<float>(const GreyImage&, int, double);
template Plane<double> median_texture<double>(const GreyImage&, int, double);

}  // namespace touchtrial::engine

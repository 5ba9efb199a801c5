#include "engine/cited_textures.hpp"

#include "engine/gaussian_filter.hpp"
#include "engine/order_map.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace touchtrial::engine {
namespace {

constexpr int kReferenceGrey = 128;
constexpr double kStrongestEdge = 127.0;  // grey level 255 in the texture picture
constexpr int kStripRows = 256;

/// The medians of a strip of rows. OpenCV's filter is exact, but it extends an image by repeating
/// the edge samples. So it filters the strip inside a mirrored frame, whose medians are ignored.
class MedianStrip {
 public:
  MedianStrip(const GreyImage& image, int radius) : image_(image), radius_(radius) {}

  void move_to(int first_row, int rows) {
    framed_strip_.create(rows + 2 * radius_, image_.width() + 2 * radius_, CV_8UC1);
    for (int y = 0; y < framed_strip_.rows; ++y) {
      copy_with_frame(image_.row(symmetric_index(first_row + y - radius_, image_.height())), y);
    }
    cv::medianBlur(framed_strip_, medians_, 2 * radius_ + 1);
  }

  /// \param y  0 is the strip's first row
  [[nodiscard]] const std::uint8_t* row(int y) const {
    return medians_.ptr<std::uint8_t>(y + radius_) + radius_;
  }

 private:
  void copy_with_frame(std::span<const std::uint8_t> row, int y) {
    std::uint8_t* const row_start = framed_strip_.ptr<std::uint8_t>(y) + radius_;
    std::ranges::copy(row, row_start);
    mirror_ends(row_start, image_.width(), radius_);
  }

  const GreyImage& image_;
  int radius_;
  cv::Mat framed_strip_;
  cv::Mat medians_;
};

}  // namespace

template <typename Real>
Plane<Real> gaussian_texture(const GreyImage& image, double sigma_px) {
  Plane<Real> texture(image.height(), image.width());
  GaussianRows smooth(image, sigma_px);
  for (int y = 0; y < image.height(); ++y) {
    const std::span<const double> levels = smooth.row(y);
    std::transform(image.row(y).begin(), image.row(y).end(), levels.begin(), texture.row(y).begin(),
                   [](std::uint8_t grey, double level) { return static_cast<Real>(grey - level); });
  }
  return texture;
}

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

template <typename Real>
Plane<Real> edge_texture(const GreyImage& image, double divisor) {
  Plane<Real> texture(image.height(), image.width());
  GradientRows gradient(image, Gradient::sobel);
  for (int y = 0; y < image.height(); ++y) {
    const std::span<const double> norms = gradient.row(y);
    std::transform(norms.begin(), norms.end(), texture.row(y).begin(), [divisor](double norm) {
      return static_cast<Real>(std::min(kStrongestEdge, norm / divisor));
    });
  }
  return texture;
}

template <typename Real>
Plane<Real> luminance_texture(const GreyImage& image) {
  Plane<Real> texture(image.height(), image.width());
  std::ranges::transform(image.samples(), texture.samples().begin(), [](std::uint8_t grey) {
    return static_cast<Real>(grey - kReferenceGrey);
  });
  return texture;
}

template Plane<float> gaussian_texture<float>(const GreyImage&, double);
template Plane<double> gaussian_texture<double>(const GreyImage&, double);
template Plane<float> median_texture<float>(const GreyImage&, int, double);
template Plane<double> median_texture<double>(const GreyImage&, int, double);
template Plane<float> edge_texture<float>(const GreyImage&, double);
template Plane<double> edge_texture<double>(const GreyImage&, double);
template Plane<float> luminance_texture<float>(const GreyImage&);
template Plane<double> luminance_texture<double>(const GreyImage&);

}  // namespace touchtrial::engine

#include "engine/pictures/colour_image.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace touchtrial::engine {
namespace {

/// Filtered rows and zlib's best effort: textures pack poorly, so every per cent is welcome.
Bytes encoded(const cv::Mat& pixels) {
  const std::vector<int> options = {cv::IMWRITE_PNG_COMPRESSION, 9, cv::IMWRITE_PNG_STRATEGY,
                                    cv::IMWRITE_PNG_STRATEGY_FILTERED};
  Bytes bytes;
  try {
    if (cv::imencode(".png", pixels, bytes, options) && !bytes.empty()) return bytes;
  } catch (const cv::Exception&) {
    // What it says names its own sources, not the picture.
  }
  throw FileError("a picture cannot be encoded as PNG; give a smaller image");
}

void require_pixels(bool empty, const char* who) {
  if (empty) throw std::invalid_argument(std::string(who) + ": the image has no pixels");
}

}  // namespace

Bytes png_bytes(const GreyImage& image) {
  require_pixels(image.empty(), "png_bytes");
  cv::Mat pixels(image.height(), image.width(), CV_8UC1);
  for (int y = 0; y < image.height(); ++y) std::ranges::copy(image.row(y), pixels.ptr(y));
  return encoded(pixels);
}

Bytes png_bytes(const ColourImage& image) {
  require_pixels(image.empty(), "png_bytes");
  cv::Mat pixels(image.height(), image.width(), CV_8UC3);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const Rgb& pixel = image.at(y, x);
      pixels.at<cv::Vec3b>(y, x) = cv::Vec3b(pixel.blue, pixel.green, pixel.red);
    }
  }
  return encoded(pixels);
}

GreyImage resized(const GreyImage& image, int height, int width) {
  require_pixels(image.empty(), "resized");
  if (height < 1 || width < 1) throw std::invalid_argument("resized: a side is below 1");
  cv::Mat from(image.height(), image.width(), CV_64FC1);
  for (int y = 0; y < image.height(); ++y) std::ranges::copy(image.row(y), from.ptr<double>(y));
  const bool shrinks = height <= image.height() && width <= image.width();
  cv::Mat to;
  cv::resize(from, to, cv::Size(width, height), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_CUBIC);
  GreyImage result(height, width);
  for (int y = 0; y < height; ++y) {
    std::ranges::transform(
        std::span(to.ptr<double>(y), static_cast<std::size_t>(width)), result.row(y).begin(),
        [](double grey) {
          return static_cast<std::uint8_t>(std::clamp(std::floor(grey + 0.5), 0.0, 255.0));
        });
  }
  return result;
}

}  // namespace touchtrial::engine

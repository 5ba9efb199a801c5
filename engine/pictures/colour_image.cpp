#include "engine/pictures/colour_image.hpp"

#include "core/errors.hpp"
#include "engine/image_formats/image_format.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace touchtrial::engine {
namespace {

Bytes encode_png(int height, int width, int channels, std::span<const std::uint8_t> samples) {
  try {
    return png_of_samples(height, width, channels, samples);
  } catch (const ImageFault&) {
    throw FileError("a picture cannot be encoded as PNG; give a smaller image");
  }
}

void require_pixels(bool empty, const char* caller) {
  if (empty) throw std::invalid_argument(std::string(caller) + ": the image has no pixels");
}

}  // namespace

Bytes png_bytes(const GreyImage& image) {
  require_pixels(image.empty(), "png_bytes");
  return encode_png(image.height(), image.width(), 1, image.samples());
}

Bytes png_bytes(const ColourImage& image) {
  require_pixels(image.empty(), "png_bytes");
  Bytes samples;
  samples.reserve(3 * image.size());
  for (const Rgb& pixel : image.samples()) {
    samples.insert(samples.end(), {pixel.red, pixel.green, pixel.blue});
  }
  return encode_png(image.height(), image.width(), 3, samples);
}

GreyImage resized(const GreyImage& image, int height, int width) {
  require_pixels(image.empty(), "resized");
  if (height < 1 || width < 1) throw std::invalid_argument("resized: a side is below 1");
  cv::Mat input(image.height(), image.width(), CV_64FC1);
  for (int y = 0; y < image.height(); ++y) std::ranges::copy(image.row(y), input.ptr<double>(y));
  const bool shrinks = height <= image.height() && width <= image.width();
  cv::Mat output;
  cv::resize(input, output, cv::Size(width, height), 0, 0,
             shrinks ? cv::INTER_AREA : cv::INTER_CUBIC);
  GreyImage result(height, width);
  for (int y = 0; y < height; ++y) {
    std::ranges::transform(
        std::span(output.ptr<double>(y), static_cast<std::size_t>(width)), result.row(y).begin(),
        [](double grey) {
          return static_cast<std::uint8_t>(std::clamp(std::floor(grey + 0.5), 0.0, 255.0));
        });
  }
  return result;
}

}  // namespace touchtrial::engine

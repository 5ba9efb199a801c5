#include "engine/example_images.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial {
namespace {

template <typename LevelAt>
GreyImage painted(Size size, LevelAt level_at) {
  GreyImage image(size.height, size.width);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image.at(y, x) = static_cast<std::uint8_t>(level_at(y, x));
  }
  return image;
}

}  // namespace

const std::vector<Size>& awkward_sizes() {
  static const std::vector<Size> sizes = {{1, 1}, {1, 2}, {1, 17}, {17, 1}, {2, 1},
                                          {2, 2}, {3, 3}, {5, 7},  {7, 4},  {64, 63}};
  return sizes;
}

const std::vector<Size>& stimulus_sizes() {
  static const std::vector<Size> sizes = {{500, 500}, {501, 499}};
  return sizes;
}

GreyImage flat_image(Size size, int level) {
  return {size.height, size.width, static_cast<std::uint8_t>(level)};
}

GreyImage ramp_image(Size size, int slope) {
  return painted(size, [slope](int, int x) { return (slope * x + 3) % 256; });
}

GreyImage step_image(Size size, std::uint8_t low, std::uint8_t high) {
  return painted(size, [=](int, int x) { return x < size.width / 2 ? low : high; });
}

GreyImage checkerboard(Size size) {
  return painted(size, [](int y, int x) { return (x + y) % 2 == 0 ? 0 : 255; });
}

GreyImage noise_image(Size size, std::uint64_t seed) {
  RandomStream random(seed, "noise image");
  return painted(size, [&](int, int) { return random.below(256); });
}

GreyImage speckle_image(Size size, std::uint64_t seed) {
  RandomStream random(seed, "speckle image");
  return painted(size, [&](int, int) { return random.below(2) * 255; });
}

GreyImage cloth_image(Size size, std::uint64_t seed) {
  RandomStream random(seed, "cloth image");
  return painted(size, [&](int y, int x) {
    const bool smooth = x > 2 * size.width / 3;  // a part with hardly any gradient
    const double threads = 45.0 * std::sin(1.3 * x + 0.4 * std::sin(0.05 * y)) * std::sin(0.9 * y);
    const double shading = 30.0 * std::sin(0.02 * x + 0.01 * y);
    const double level =
        smooth ? 120.0 + 0.2 * shading : 128.0 + threads + shading + random.uniform(-12.0, 12.0);
    return std::clamp(level, 0.0, 255.0);
  });
}

std::vector<NamedImage> example_images(Size size) {
  return {{"black", flat_image(size, 0)},   {"mid-grey", flat_image(size, 128)},
          {"white", flat_image(size, 255)}, {"ramp", ramp_image(size, 3)},
          {"step", step_image(size)},       {"checkerboard", checkerboard(size)},
          {"noise", noise_image(size)},     {"speckle", speckle_image(size)},
          {"cloth", cloth_image(size)}};
}

GreyImage negative_of(const GreyImage& image) {
  GreyImage negative = image;
  for (std::uint8_t& sample : negative.samples()) sample = static_cast<std::uint8_t>(255 - sample);
  return negative;
}

}  // namespace touchtrial

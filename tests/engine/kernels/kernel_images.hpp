/// \file What the vectorised kernels are tried on.
#pragma once

#include "engine/example_images.hpp"

#include <vector>

namespace touchtrial {

/// Sizes around the borders, and on both sides of the lengths of vectors and tiles.
inline const std::vector<Size>& kernel_sizes() {
  static const std::vector<Size> sizes = {{1, 1}, {1, 19}, {19, 1}, {2, 2},  {3, 3},
                                          {5, 7}, {4, 32}, {6, 33}, {64, 63}};
  return sizes;
}

/// One bright pixel in the dark.
inline GreyImage impulse_image(Size size) {
  GreyImage image(size.height, size.width);
  image.at(size.height / 2, size.width / 2) = 255;
  return image;
}

/// Noise, a photograph's mixture, constants, checkerboard, impulse, step and ramps; a ramp of slope
/// 4 sits exactly on a branch of the order map.
inline std::vector<NamedImage> kernel_images(Size size) {
  std::vector<NamedImage> images = example_images(size);
  images.push_back({"impulse", impulse_image(size)});
  images.push_back({"ramp of slope 4", ramp_image(size, 4)});
  return images;
}

}  // namespace touchtrial

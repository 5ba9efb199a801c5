/// \file Test images for the engine: plain ones with a known result, and irregular ones.
#pragma once

#include "core/plane.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace touchtrial {

struct Size {
  int height;
  int width;
};

/// Sizes at which borders, odd lengths and missing neighbours matter.
[[nodiscard]] const std::vector<Size>& awkward_sizes();
/// The sizes of real stimuli, one even and one odd.
[[nodiscard]] const std::vector<Size>& stimulus_sizes();

[[nodiscard]] GreyImage flat_image(Size size, int level);
/// slope * x + 3, modulo 256.
[[nodiscard]] GreyImage ramp_image(Size size, int slope = 1);
/// `low` in the left half, `high` in the right.
[[nodiscard]] GreyImage step_image(Size size, std::uint8_t low = 40, std::uint8_t high = 200);
/// 0 and 255, alternating.
[[nodiscard]] GreyImage checkerboard(Size size);
/// Every level equally likely.
[[nodiscard]] GreyImage noise_image(Size size, std::uint64_t seed = 1);
/// Black and white at random: the largest differences that an image can have.
[[nodiscard]] GreyImage speckle_image(Size size, std::uint64_t seed = 1);
/// Threads of cloth with noise and smooth shading: all branches of the order map occur.
[[nodiscard]] GreyImage cloth_image(Size size, std::uint64_t seed = 1);

struct NamedImage {
  std::string name;
  GreyImage image;
};

/// One of each kind at this size.
[[nodiscard]] std::vector<NamedImage> example_images(Size size);

/// 255 - image.
[[nodiscard]] GreyImage negative_of(const GreyImage& image);

}  // namespace touchtrial

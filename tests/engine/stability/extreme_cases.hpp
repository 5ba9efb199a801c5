/// \file Stress tests for the engine: the images, sizes and options at which arithmetic fails
/// first, and functions that run a law in both precisions on every instruction set.
#pragma once

#include "core/plane.hpp"
#include "engine/every_simd_target.hpp"
#include "engine/example_images.hpp"
#include "engine/extraction_options.hpp"

#include <string>
#include <vector>

namespace touchtrial {

/// A single pixel, lines, squares without inner pixels, and odd sides.
[[nodiscard]] const std::vector<Size>& extreme_sizes();

/// Constants 0, 128 and 255, checkerboard, impulse, step, ramps (one of slope 4, whose CSGV is the
/// branch point 128), noise, and one bright pixel in the corner.
[[nodiscard]] std::vector<NamedImage> extreme_images(Size size);

/// A method with its options, and the bound of its textures.
struct ExtractionCase {
  std::string name;
  engine::ExtractionOptions options;
  double largest_texture = 0.0;  ///< the bound of |T| for any 8-bit image
};

/// Every method but tv-gabor, and every norm, gradient and combination; radii from 1 to 63, orders
/// from 0 to the largest number below 1, and the ends of all other ranges.
[[nodiscard]] const std::vector<ExtractionCase>& extraction_cases();

/// Calls law<float>() on every target of this machine, and law<double>() once: it has no targets.
template <typename Law>
void in_both_precisions(const Law& law) {
  on_every_simd_target([&] { law.template operator()<float>(); });
  INFO("in double");
  law.template operator()<double>();
}

/// Whether a vectorised kernel computes the float textures of this case. The others are rounded
/// from double, and so need to run on one target only.
[[nodiscard]] bool has_kernel(const ExtractionCase& extraction);

/// Calls law<Real>(extraction, image) for every case and every extreme image of every extreme size,
/// as in_both_precisions() does.
template <typename Law>
void for_every_extreme(const Law& law) {
  const auto with = [&]<typename Real>(auto wanted) {
    for (const Size size : extreme_sizes()) {
      for (const auto& [name, image] : extreme_images(size)) {
        for (const ExtractionCase& extraction : extraction_cases()) {
          if (!wanted(extraction)) continue;
          INFO(extraction.name << ", " << name << ", " << size.height << " x " << size.width);
          law.template operator()<Real>(extraction, image);
        }
      }
    }
  };
  on_every_simd_target([&] { with.template operator()<float>(has_kernel); });
  with.template operator()<float>([](const auto& extraction) { return !has_kernel(extraction); });
  with.template operator()<double>([](const auto&) { return true; });
}

/// The image with its levels divided by `divisor`, then raised by `offset`.
[[nodiscard]] GreyImage rescaled(const GreyImage& image, int divisor, int offset);

}  // namespace touchtrial

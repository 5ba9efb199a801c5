#include "engine/csgv.hpp"

#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/adaptive_reference.hpp"
#include "support/catch.hpp"

#include <cstdint>

namespace touchtrial {
namespace {

Plane<double> csgv_of(const GreyImage& image) {
  return engine::doubled<double>(engine::composite_gradient(engine::daub4_sub_bands(image)),
                                 image.height(), image.width());
}

TEST_CASE("csgv of a flat image is exactly zero") {
  for (int level = 0; level < 256; level += 5) {
    const GreyImage image = flat_image({9, 12}, level);
    CHECK(largest_magnitude(csgv_of(image)) == 0.0);
  }
}

TEST_CASE("csgv of a ramp is 32 times its slope inside") {
  // LL doubles the level and halves the pixels, so its slope is 4 s; Sobel has a gain of 8.
  const Plane<double> csgv = csgv_of(ramp_image({24, 30}, 3));
  for (int x = 4; x < 24; ++x) CHECK(csgv.at(11, x) == Approx(96.0).epsilon(1e-12));
}

TEST_CASE("csgv does not know a negative from a positive") {
  const GreyImage image = cloth_image({63, 64});
  CHECK(largest_relative_difference(csgv_of(negative_of(image)), csgv_of(image)) < 1e-11);
}

TEST_CASE("doubled repeats every sample in a square of two, less at an odd edge") {
  Plane<double> half(2, 2);
  half.at(0, 1) = 1.0;
  half.at(1, 0) = 2.0;
  half.at(1, 1) = 3.0;
  const Plane<float> full = engine::doubled<float>(half, 3, 4);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) CHECK(full.at(y, x) == static_cast<float>(half.at(y / 2, x / 2)));
  }
}

TEST_CASE("csgv agrees with its definition at every size") {
  for (const Size size : awkward_sizes()) {
    for (const auto& [name, image] : example_images(size)) {
      INFO(name << ", " << size.height << " x " << size.width);
      CHECK(largest_relative_difference(csgv_of(image), reference::csgv(image)) < 1e-11);
    }
  }
  for (const Size size : stimulus_sizes()) {
    const GreyImage image = cloth_image(size);
    CHECK(largest_relative_difference(csgv_of(image), reference::csgv(image)) < 1e-11);
  }
}

}  // namespace
}  // namespace touchtrial

#include "engine/daub4.hpp"

#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "support/catch.hpp"

#include <stdexcept>

namespace touchtrial {
namespace {

using reference::Tap;

double energy(const Plane<double>& plane) {
  double sum = 0.0;
  for (const double sample : plane.samples()) sum += sample * sample;
  return sum;
}

double energy(const engine::SubBands& bands) {
  return energy(bands.ll) + energy(bands.lh) + energy(bands.hl) + energy(bands.hh);
}

TEST_CASE("daub4 turns a constant c into ll = 2c and no details") {
  for (const int level : {0, 1, 128, 255}) {
    const engine::SubBands bands = engine::daub4_sub_bands(flat_image({9, 6}, level));
    REQUIRE(bands.ll.height() == 5);
    REQUIRE(bands.ll.width() == 3);
    CHECK(largest_difference(bands.ll, Plane<double>(5, 3, 2.0 * level)) < 1e-12);
    CHECK(largest_magnitude(bands.lh) < 1e-12);
    CHECK(largest_magnitude(bands.hl) < 1e-12);
    CHECK(largest_magnitude(bands.hh) < 1e-12);
  }
}

TEST_CASE("daub4 has no details inside a ramp, because its filters have two vanishing moments") {
  const engine::SubBands bands = engine::daub4_sub_bands(ramp_image({20, 40}, 5));
  for (int x = 0; x < 18; ++x) CHECK(bands.hl.at(4, x) == Approx(0.0).margin(1e-11));
  CHECK(largest_magnitude(bands.hh) < 1e-11);
}

TEST_CASE("daub4 keeps the energy of an image in a black frame") {
  // The frame keeps the filters from the mirrored samples, so the transform is orthonormal.
  GreyImage image(40, 52);
  const GreyImage noise = noise_image({40, 52});
  double expected = 0.0;
  for (int y = 4; y < 36; ++y) {
    for (int x = 4; x < 48; ++x) {
      image.at(y, x) = noise.at(y, x);
      expected += static_cast<double>(image.at(y, x)) * image.at(y, x);
    }
  }
  CHECK(energy(engine::daub4_sub_bands(image)) == Approx(expected).epsilon(1e-13));
}

TEST_CASE("daub4 distinguishes vertical and horizontal edges") {
  const engine::SubBands vertical = engine::daub4_sub_bands(step_image({16, 18}));
  CHECK(largest_magnitude(vertical.hl) > 10.0);
  CHECK(largest_magnitude(vertical.lh) < 1e-12);
}

TEST_CASE("daub4 agrees with its definition at every size") {
  auto sizes = awkward_sizes();
  sizes.insert(sizes.end(), stimulus_sizes().begin(), stimulus_sizes().end());
  for (const Size size : sizes) {
    for (const GreyImage& image : {noise_image(size), cloth_image(size), ramp_image(size, 3)}) {
      const engine::SubBands bands = engine::daub4_sub_bands(image);
      INFO("size " << size.height << " x " << size.width);
      CHECK(largest_relative_difference(bands.ll, reference::sub_band(image, Tap::low, Tap::low)) <
            1e-12);
      CHECK(largest_relative_difference(bands.lh, reference::sub_band(image, Tap::low, Tap::high)) <
            1e-12);
      CHECK(largest_relative_difference(bands.hl, reference::sub_band(image, Tap::high, Tap::low)) <
            1e-12);
      CHECK(largest_relative_difference(bands.hh,
                                        reference::sub_band(image, Tap::high, Tap::high)) < 1e-12);
    }
  }
}

TEST_CASE("daub4 refuses an empty image") {
  CHECK_THROWS_AS(engine::daub4_sub_bands(GreyImage()), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

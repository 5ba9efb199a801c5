#include "engine/metrics/ssim.hpp"

#include "engine/example_images.hpp"
#include "engine/reference/ssim_reference.hpp"
#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstddef>

namespace touchtrial {
namespace {

constexpr double kC1 = 0.01 * 255 * 0.01 * 255;
constexpr double kTolerance = 1e-11;

/// A worn state of the same texture: less contrast, and noise.
GreyImage worn(const GreyImage& image) {
  GreyImage result = image;
  const GreyImage noise = noise_image({image.height(), image.width()}, 7);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result.samples()[i] =
        static_cast<std::uint8_t>(30 + image.samples()[i] * 3 / 4 + noise.samples()[i] / 16);
  }
  return result;
}

TEST_CASE("ms_ssim of an image and itself is exactly 1") {
  for (const Size size : {Size{161, 161}, Size{161, 300}, Size{175, 163}}) {
    for (const auto& [name, image] : example_images(size)) {
      INFO(name << ", " << size.height << " x " << size.width);
      CHECK(engine::ms_ssim(image, image).unit == 1.0);
      CHECK(engine::ms_ssim(image, image).wang == 1.0);
    }
  }
}

TEST_CASE("ms_ssim of different images is below 1, however little they differ") {
  const GreyImage image = cloth_image({170, 180});
  GreyImage other = image;
  ++other.at(60, 60);
  CHECK(engine::ms_ssim(image, other).unit < 1.0);
  CHECK(engine::ms_ssim(image, other).unit > 1.0 - 1e-4);
}

TEST_CASE("ms_ssim of two flat images is l of the last scale") {
  const double l = (2.0 * 90 * 120 + kC1) / (90 * 90 + 120 * 120 + kC1);
  const engine::MsSsim result =
      engine::ms_ssim(flat_image({161, 162}, 90), flat_image({161, 162}, 120));
  CHECK(result.unit == Approx(l).epsilon(kTolerance));
  CHECK(result.wang == Approx(std::pow(l, 0.1333)).epsilon(kTolerance));
}

TEST_CASE("a negative mean counts in ms_ssim with unit exponents, and as 0 with Wang's") {
  const GreyImage board = checkerboard({162, 176});  // flat from the second scale on
  const engine::MsSsim result = engine::ms_ssim(board, negative_of(board));
  CHECK(result.unit < -0.99);
  CHECK(result.wang == 0.0);
}

TEST_CASE("ms_ssim agrees with its definition, window by window") {
  const std::vector<NamedImage> images = example_images({161, 171});
  for (std::size_t i = 0; i < images.size(); ++i) {
    const NamedImage& one = images[i];
    const NamedImage& next = images[(i + 1) % images.size()];
    INFO(one.name << " and " << next.name);
    for (const GreyImage& other : {next.image, worn(one.image), negative_of(one.image)}) {
      const reference::MsSsim expected = reference::ms_ssim(one.image, other);
      const engine::MsSsim found = engine::ms_ssim(one.image, other);
      CHECK(std::abs(found.unit - expected.unit) < kTolerance);
      CHECK(std::abs(found.wang - expected.wang) < kTolerance);
    }
  }
}

TEST_CASE("ms_ssim refuses images of different or too small sizes") {
  CHECK(refusal_of([] { (void)engine::ms_ssim(GreyImage(200, 210), GreyImage(210, 200)); }) ==
        "ms_ssim: the images differ in size, 200 x 210 and 210 x 200 pixels");
  CHECK(refusal_of([] { (void)engine::ms_ssim(GreyImage(500, 160), GreyImage(500, 160)); }) ==
        "ms_ssim: the images are 500 x 160 pixels, and both sides must be at least 161");
}

}  // namespace
}  // namespace touchtrial

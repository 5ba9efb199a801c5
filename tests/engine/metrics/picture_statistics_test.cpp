#include "engine/metrics/picture_statistics.hpp"

#include "engine/example_images.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::engine;

TEST_CASE("entropy of a constant image is exactly zero") {
  for (const int level : {0, 128, 255}) {
    const double value = entropy(flat_image({7, 5}, level));
    CHECK(value == 0.0);
    CHECK_FALSE(std::signbit(value));
  }
}

TEST_CASE("entropy of all levels in equal shares is ln 256") {
  GreyImage image(16, 16);
  std::iota(image.samples().begin(), image.samples().end(), std::uint8_t{0});
  CHECK(entropy(image) == Approx(std::log(256.0)).epsilon(1e-14));
}

TEST_CASE("entropy of two levels follows from their shares") {
  GreyImage image(1, 4);
  image.at(0, 3) = 200;
  CHECK(entropy(image) == Approx(-0.75 * std::log(0.75) - 0.25 * std::log(0.25)).epsilon(1e-14));
}

TEST_CASE("entropy does not depend on where the samples lie") {
  const GreyImage tall = ramp_image({1, 60}, 5);
  GreyImage wide(60, 1);
  for (int i = 0; i < 60; ++i) wide.at(59 - i, 0) = tall.at(0, i);
  CHECK(entropy(wide) == Approx(entropy(tall)).epsilon(1e-14));
}

TEST_CASE("entropy refuses an empty image") {
  CHECK_THROWS_AS(entropy(GreyImage()), std::invalid_argument);
}

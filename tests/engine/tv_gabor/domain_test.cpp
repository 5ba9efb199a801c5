#include "engine/tv_gabor/domain.hpp"

#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/mirror.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

TEST_CASE("torus_length is even, long enough, and has no prime factor above 7") {
  CHECK(engine::torus_length(500) == 540);
  CHECK(engine::torus_length(1) == 36);
  CHECK(engine::torus_length(10) == 42);
  CHECK(engine::torus_length(12) == 48);
  for (int n = 1; n < 700; ++n) {
    const int length = engine::torus_length(n);
    INFO("n " << n);
    REQUIRE(length % 2 == 0);
    REQUIRE(length >= n + 32);
    REQUIRE(length >= engine::torus_length(n > 1 ? n - 1 : 1));
  }
}

TEMPLATE_TEST_CASE("extended_to_torus mirrors the image on all sides", "", float, double) {
  for (const Size size : {Size{1, 1}, Size{1, 6}, Size{5, 3}, Size{40, 33}}) {
    const GreyImage image = noise_image(size);
    const Plane<TestType> torus = engine::extended_to_torus<TestType>(image);
    REQUIRE(torus.height() == engine::torus_length(size.height));
    REQUIRE(torus.width() == engine::torus_length(size.width));
    for (int y = 0; y < torus.height(); ++y) {
      for (int x = 0; x < torus.width(); ++x) {
        REQUIRE(torus.at(y, x) == reference::mirrored_sample(image, y - 16, x - 16));
      }
    }
    CHECK(largest_difference(engine::cropped_from_torus(torus, size.height, size.width), image) ==
          0.0);
  }
}

}  // namespace
}  // namespace touchtrial

#include "bench/peers/gl_filters.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "support/catch.hpp"

namespace touchtrial::bench {
namespace {

TEST_CASE("filter_adaptive gives the texture that an extraction gives for its orders") {
  engine::ExtractionOptions options;
  options.radius = 3;
  engine::WantedPlanes wanted;
  wanted.order = true;
  Plane<float> texture(2, 2);
  for (const Size size : {Size{1, 1}, Size{3, 5}, Size{64, 63}, Size{270, 281}}) {
    const GreyImage image = cloth_image(size);
    const auto expected = engine::extract_texture<float>(image, options, wanted);
    filter_adaptive(image, 3, expected.order, texture);
    CHECK(texture == expected.texture);
  }
}

}  // namespace
}  // namespace touchtrial::bench

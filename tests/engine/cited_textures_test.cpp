#include "engine/cited_textures.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

using namespace engine;

ExtractionOptions options_of(Method method) {
  return {.method = method};
}

TEST_CASE("the gaussian texture agrees with its definition") {
  for (const Size size : awkward_sizes()) {
    const GreyImage image = noise_image(size);
    INFO(size.height << " x " << size.width);
    CHECK(largest_difference(engine::gaussian_texture<double>(image, 2.0),
                             reference::gaussian_texture(image, 2.0)) < 1e-9);
  }
  const GreyImage image = cloth_image({20, 17});
  CHECK(largest_difference(engine::gaussian_texture<double>(image, 0.4),
                           reference::gaussian_texture(image, 0.4)) < 1e-9);
}

TEST_CASE("the median texture equals its definition exactly") {
  for (const Size size : awkward_sizes()) {
    for (const auto& [name, image] : example_images(size)) {
      for (const int radius : {1, 2, 6}) {
        INFO(name << ", " << size.height << " x " << size.width << ", radius " << radius);
        CHECK(engine::median_texture<double>(image, radius, 4.0) ==
              reference::median_texture(image, radius, 4.0));
      }
    }
  }
  const GreyImage image = noise_image({12, 9});
  CHECK(engine::median_texture<double>(image, 63, 0.0) ==
        reference::median_texture(image, 63, 0.0));
}

TEST_CASE("the edge texture agrees with its definition and ends at 127") {
  for (const Size size : awkward_sizes()) {
    for (const auto& [name, image] : example_images(size)) {
      INFO(name << ", " << size.height << " x " << size.width);
      CHECK(largest_difference(engine::edge_texture<double>(image, 4.0),
                               reference::edge_texture(image, 4.0)) < 1e-11);
    }
  }
  CHECK(largest_magnitude(engine::edge_texture<double>(step_image({8, 8}, 0, 255), 4.0)) == 127.0);
  CHECK(engine::edge_texture<double>(step_image({8, 8}, 100, 110), 4.0).at(4, 4) == 10.0);
}

TEST_CASE("the luminance texture's picture is the image") {
  const GreyImage image = noise_image({10, 13});
  CHECK(luminance_texture<double>(image).at(3, 4) == image.at(3, 4) - 128.0);
  const auto texture = extract_texture<float>(image, options_of(Method::luminance)).texture;
  CHECK(engine::texture_picture(texture) == image);
}

TEST_CASE("a float texture of the cited extractors is the double one rounded") {
  const GreyImage image = cloth_image({31, 20});
  for (const Method method : {Method::gaussian, Method::median, Method::edge, Method::luminance}) {
    const auto exact = extract_texture<double>(image, options_of(method)).texture;
    CHECK(extract_texture<float>(image, options_of(method)).texture == converted<float>(exact));
  }
}

TEST_CASE("the cited extractors give the enhanced image and no other by-product") {
  const GreyImage image = cloth_image({12, 12});
  for (const Method method : {Method::gaussian, Method::median, Method::edge, Method::luminance}) {
    const auto result = extract_texture<double>(image, options_of(method), RequestedPlanes::all());
    CHECK(result.enhanced.at(5, 6) == image.at(5, 6) + result.texture.at(5, 6));
    CHECK(result.order.empty());
    CHECK(result.csgv.empty());
    CHECK(result.sub_band_ll.empty());
    CHECK(result.cartoon.empty());
  }
}

}  // namespace
}  // namespace touchtrial

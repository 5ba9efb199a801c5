#include "engine/every_simd_target.hpp"
#include "engine/gl_texture.hpp"
#include "engine/kernels/kernel_images.hpp"
#include "engine/plane_comparison.hpp"
#include "support/catch.hpp"

#include <cstddef>

namespace touchtrial {
namespace {

/// In grey levels, on any 8-bit image.
constexpr double kTolerance = 4e-5;

/// Orders at half resolution that reach both ends of [0, 1).
Plane<double> mixed_orders(const GreyImage& image) {
  Plane<double> orders((image.height() + 1) / 2, (image.width() + 1) / 2);
  constexpr double kOrders[] = {0.0, 1e-300, 0.3, 0.666, 0.999, 1.0 - 1e-7};
  for (std::size_t i = 0; i < orders.size(); ++i) orders.samples()[i] = kOrders[i % 6];
  return orders;
}

void check_against_double(const GreyImage& image, int radius) {
  const Plane<double> orders = mixed_orders(image);
  CHECK(largest_difference(engine::gl_texture<float>(image, radius, orders),
                           engine::gl_texture<double>(image, radius, orders)) < kTolerance);
  for (const double order : {0.05, 0.55, 0.999}) {
    CHECK(largest_difference(engine::gl_texture<float>(image, radius, order),
                             engine::gl_texture<double>(image, radius, order)) < kTolerance);
  }
}

TEST_CASE("gl_row agrees with double on every target, at every size and radius") {
  on_every_simd_target([] {
    for (const Size size : kernel_sizes()) {
      for (const auto& [name, image] : kernel_images(size)) {
        for (const int radius : {1, 2, 3, 7, 63}) {
          INFO(name << ", " << size.height << " x " << size.width << ", radius " << radius);
          check_against_double(image, radius);
        }
      }
    }
  });
}

TEST_CASE(
    "gl_row agrees with double on every target where a row has more than "
    "one tile") {
  const GreyImage image = speckle_image({7, 1100});
  on_every_simd_target([&] {
    for (const int radius : {1, 2, 7, 40, 63}) check_against_double(image, radius);
  });
}

TEST_CASE("gl_row agrees with double on every target on a real stimulus") {
  const GreyImage image = cloth_image({501, 499});
  on_every_simd_target([&] { check_against_double(image, 2); });
}

TEST_CASE("gl_row keeps a flat image exactly flat on every target") {
  on_every_simd_target([] {
    for (const int level : {0, 1, 127, 128, 255}) {
      const GreyImage image = flat_image({5, 37}, level);
      for (const int radius : {1, 2, 5, 63}) {
        CHECK(largest_magnitude(engine::gl_texture<float>(image, radius, mixed_orders(image))) ==
              0.0);
        CHECK(largest_magnitude(engine::gl_texture<float>(image, radius, 0.999)) == 0.0);
      }
    }
  });
}

TEST_CASE("gl_row of a negative is exactly the negative texture on every target") {
  const GreyImage image = noise_image({31, 45});
  on_every_simd_target([&] {
    for (const int radius : {1, 2, 7, 63}) {
      Plane<float> texture = engine::gl_texture<float>(image, radius, mixed_orders(image));
      for (float& sample : texture.samples()) sample = -sample;
      CHECK(engine::gl_texture<float>(negative_of(image), radius, mixed_orders(image)) == texture);
    }
  });
}

TEST_CASE("gl_row of order zero finds no texture on any target") {
  on_every_simd_target([] {
    CHECK(largest_magnitude(engine::gl_texture<float>(noise_image({20, 45}), 3, 0.0)) == 0.0);
  });
}

}  // namespace
}  // namespace touchtrial

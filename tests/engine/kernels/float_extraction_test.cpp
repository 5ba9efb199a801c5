#include "engine/kernels/float_extraction.hpp"

#include "engine/every_simd_target.hpp"
#include "engine/example_images.hpp"
#include "engine/force_field.hpp"
#include "engine/gl_texture.hpp"
#include "engine/kernels/strips.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <tbb/task_arena.h>

namespace touchtrial {
namespace {

/// Tiny sizes, and sizes just below and above the lengths of vectors and tiles.
const std::vector<Size>& kernel_sizes() {
  static const std::vector<Size> sizes = {{1, 1}, {1, 19}, {19, 1}, {2, 2},  {3, 3},
                                          {5, 7}, {4, 32}, {6, 33}, {64, 63}};
  return sizes;
}

/// One bright pixel in the dark.
GreyImage impulse_image(Size size) {
  GreyImage image(size.height, size.width);
  image.at(size.height / 2, size.width / 2) = 255;
  return image;
}

/// One image of each kind, an impulse, and a ramp of slope 4, whose CSGV is exactly at a branch
/// point of the order map.
std::vector<NamedImage> kernel_images(Size size) {
  std::vector<NamedImage> images = example_images(size);
  images.push_back({"impulse", impulse_image(size)});
  images.push_back({"ramp of slope 4", ramp_image(size, 4)});
  return images;
}

/// The promised errors in grey levels, on any 8-bit image and on photographs at K = 2.
constexpr double kAnyTolerance = 4e-5;
constexpr double kPhotographTolerance = 2e-5;

engine::ExtractionOptions adaptive_options(int radius) {
  return {.radius = radius};
}

/// The largest difference away from the branch points.
double texture_error(const Plane<float>& texture, const engine::Extraction<double>& truth) {
  double largest = 0.0;
  for (std::size_t i = 0; i < texture.size(); ++i) {
    if (reference::is_at_branch_point(truth.csgv.samples()[i])) continue;
    largest = std::max(largest, std::abs(texture.samples()[i] - truth.texture.samples()[i]));
  }
  return largest;
}

void check_on_every_target(const GreyImage& image, int radius, double tolerance) {
  const engine::ExtractionOptions options = adaptive_options(radius);
  const auto truth =
      engine::extract_texture<double>(image, options, engine::RequestedPlanes::all());
  on_every_simd_target([&] {
    CHECK(texture_error(engine::extract_texture<float>(image, options).texture, truth) < tolerance);
  });
}

TEST_CASE("the adaptive kernels agree with double on every target, at every size and radius") {
  for (const Size size : kernel_sizes()) {
    for (const auto& [name, image] : kernel_images(size)) {
      for (const int radius : {1, 2, 3, 7, 63}) {
        INFO(name << ", " << size.height << " x " << size.width << ", radius " << radius);
        check_on_every_target(image, radius, kAnyTolerance);
      }
    }
  }
}

TEST_CASE("the adaptive kernels agree with double on every target on a real stimulus size") {
  for (const auto& [name, image] : kernel_images({501, 499})) {
    INFO(name);
    check_on_every_target(image, 2, name == "cloth" ? kPhotographTolerance : kAnyTolerance);
  }
}

/// A checkerboard with one level more here and there: large texture, hardly any gradient.
GreyImage uneven_checkerboard(Size size) {
  GreyImage image = checkerboard(size);
  for (int y = 3; y < size.height; y += 11) {
    for (int x = 5; x < size.width; x += 13) {
      image.at(y, x) = static_cast<std::uint8_t>(std::abs(image.at(y, x) - 1));
    }
  }
  return image;
}

TEST_CASE("the adaptive kernels keep their precision where CSGV is small and texture large") {
  for (const int radius : {1, 2, 7}) {
    check_on_every_target(uneven_checkerboard({64, 63}), radius, kAnyTolerance);
  }
}

TEST_CASE("the adaptive kernels compute a ramp's CSGV exactly, even on the branch point") {
  on_every_simd_target([] {
    engine::RequestedPlanes wanted{.csgv = true};
    GreyImage image(40, 60);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 60; ++x) image.at(y, x) = static_cast<std::uint8_t>(4 * x + 3);
    }
    const auto result = engine::extract_texture<float>(image, adaptive_options(2), wanted);
    for (int x = 4; x < 52; ++x) REQUIRE(result.csgv.at(20, x) == 128.0F);
  });
}

void check_by_products(const GreyImage& image) {
  const auto truth =
      engine::extract_texture<double>(image, adaptive_options(2), engine::RequestedPlanes::all());
  const auto result =
      engine::extract_texture<float>(image, adaptive_options(2), engine::RequestedPlanes::all());
  CHECK(largest_relative_difference(result.csgv, truth.csgv) < 5e-7);
  CHECK(largest_difference(result.sub_band_ll, truth.sub_band_ll) < 5e-5);
  CHECK(largest_difference(result.sub_band_lh, truth.sub_band_lh) < 5e-5);
  CHECK(largest_difference(result.sub_band_hl, truth.sub_band_hl) < 5e-5);
  CHECK(largest_difference(result.sub_band_hh, truth.sub_band_hh) < 5e-5);
  CHECK(result.picture == engine::texture_picture(converted<double>(result.texture)));
  const auto force = engine::tangential_force(converted<double>(result.texture), 3);
  CHECK(largest_difference(result.force.x, force.x) < 2e-4);
  CHECK(largest_difference(result.force.y, force.y) < 2e-4);
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (reference::is_at_branch_point(truth.csgv.samples()[i])) continue;
    REQUIRE(std::abs(result.order.samples()[i] - truth.order.samples()[i]) < 3e-7);
  }
}

TEST_CASE("the adaptive kernels give the by-products of double on every target") {
  on_every_simd_target([] {
    for (const Size size : kernel_sizes()) {
      for (const auto& [name, image] : kernel_images(size)) {
        INFO(name << ", " << size.height << " x " << size.width);
        check_by_products(image);
      }
    }
  });
}

TEST_CASE(
    "an image of many rows has the same texture with and without other planes, and their "
    "picture and force on every target") {
  const GreyImage image = cloth_image({651, 619});
  const Plane<double> truth = engine::extract_texture<double>(image, adaptive_options(2)).texture;
  on_every_simd_target([&] {
    engine::RequestedPlanes wanted;
    wanted.picture = wanted.force = true;
    const auto result = engine::extract_texture<float>(image, adaptive_options(2), wanted);
    CHECK(result.texture == engine::extract_texture<float>(image, adaptive_options(2)).texture);
    CHECK(largest_difference(result.texture, truth) < kPhotographTolerance);
    CHECK(result.picture == engine::texture_picture(result.texture));
    const auto force = engine::tangential_force(result.texture, 3);
    CHECK(result.force.x == force.x);
    CHECK(result.force.y == force.y);
  });
}

/// Holds the planes of an image that is worked on in pieces against double, and against one thread.
void check_pieces(const GreyImage& image, double tolerance) {
  engine::RequestedPlanes wanted;
  wanted.picture = wanted.order = wanted.csgv = true;
  const auto truth = engine::extract_texture<double>(image, adaptive_options(2), wanted);
  on_every_simd_target([&] {
    const auto result = engine::extract_texture<float>(image, adaptive_options(2), wanted);
    CHECK(largest_difference(result.texture, truth.texture) < tolerance);
    CHECK(largest_difference(result.order, truth.order) < 1e-6);
    CHECK(largest_relative_difference(result.csgv, truth.csgv) < 5e-7);
    CHECK(result.picture == engine::texture_picture(result.texture));
    engine::Extraction<float> alone;
    tbb::task_arena one(1);
    one.execute([&] { engine::extract_texture_into(image, adaptive_options(2), wanted, alone); });
    CHECK(result.texture == alone.texture);
    CHECK(result.order == alone.order);
    CHECK(result.csgv == alone.csgv);
    CHECK(result.picture == alone.picture);
  });
}

TEST_CASE("a megapixel is extracted by several threads at once, to the same digits as by one") {
  const GreyImage image = cloth_image({1003, 1009});
  REQUIRE(static_cast<std::int64_t>(image.size()) >= engine::kMinParallelPixels);
  check_pieces(image, kPhotographTolerance);
}

/// The texture of one order, by extract_fixed().
Plane<float> texture_of(const GreyImage& image, int radius, double order) {
  engine::ExtractionOptions options{
      .method = engine::Method::fixed, .radius = radius, .order = order};
  return engine::extract_texture<float>(image, options).texture;
}

TEST_CASE("an image that is processed in tiles has the planes of double, at every tile's ends") {
  for (const Size size : {Size{3, 700'003}, Size{1447, 1450}}) {
    const GreyImage image = noise_image(size);
    REQUIRE(static_cast<std::int64_t>(image.size()) >= engine::kMinLargePixels);
    check_pieces(image, kAnyTolerance);
    const Plane<double> fixed = engine::gl_texture<double>(image, 63, 0.55);
    on_every_simd_target(
        [&] { CHECK(largest_difference(texture_of(image, 63, 0.55), fixed) < kAnyTolerance); });
  }
}

TEST_CASE("an image that is processed in several strips has the CSGV of double") {
  const GreyImage image = noise_image({5, 2100});
  engine::RequestedPlanes wanted{.csgv = true};
  const auto truth = engine::extract_texture<double>(image, adaptive_options(1), wanted);
  on_every_simd_target([&] {
    const auto result = engine::extract_texture<float>(image, adaptive_options(1), wanted);
    CHECK(largest_relative_difference(result.csgv, truth.csgv) < 5e-7);
  });
}

TEST_CASE("a reused extraction holds the wanted planes of the last image") {
  engine::Extraction<float> result;
  engine::extract_texture_into(noise_image({20, 30}), adaptive_options(3),
                               engine::RequestedPlanes::all(), result);
  const GreyImage image = cloth_image({20, 30});
  const float* const texture = result.texture.samples().data();
  engine::extract_texture_into(image, adaptive_options(2), {}, result);
  CHECK(result.texture.samples().data() == texture);
  CHECK(result.texture == engine::extract_texture<float>(image, adaptive_options(2)).texture);
  CHECK(result.sub_band_ll.empty());
  CHECK(result.order.empty());
  CHECK(result.picture.empty());
  CHECK(result.force.x.empty());
  CHECK(result.enhanced.empty());
}

TEST_CASE("extract_sub_bands gives the sub-bands that an extraction gives") {
  const GreyImage image = noise_image({21, 36});
  engine::RequestedPlanes wanted{.sub_bands = true};
  const auto expected = engine::extract_texture<float>(image, adaptive_options(2), wanted);
  engine::Extraction<float> result;
  engine::extract_sub_bands(image, result);
  CHECK(result.sub_band_ll == expected.sub_band_ll);
  CHECK(result.sub_band_lh == expected.sub_band_lh);
  CHECK(result.sub_band_hl == expected.sub_band_hl);
  CHECK(result.sub_band_hh == expected.sub_band_hh);
}

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
                           engine::gl_texture<double>(image, radius, orders)) < kAnyTolerance);
  for (const double order : {0.05, 0.55, 0.999}) {
    CHECK(largest_difference(texture_of(image, radius, order),
                             engine::gl_texture<double>(image, radius, order)) < kAnyTolerance);
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

TEST_CASE("gl_row agrees with double on every target if a row has more than one tile") {
  const GreyImage image = speckle_image({7, 1100});
  on_every_simd_target([&] {
    for (const int radius : {1, 2, 7, 40, 63}) check_against_double(image, radius);
  });
}

TEST_CASE("gl_row agrees with double on every target on a real stimulus") {
  const GreyImage image = cloth_image({501, 499});
  on_every_simd_target([&] { check_against_double(image, 2); });
}

}  // namespace
}  // namespace touchtrial

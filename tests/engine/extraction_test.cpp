#include "engine/extraction.hpp"

#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace touchtrial {
namespace {

using namespace engine;

constexpr double kDoubleTolerance = 1e-10;
constexpr double kFloatTolerance = 4e-5;

ExtractionOptions adaptive_options(int radius = 2) {
  return {.radius = radius};
}

ExtractionOptions fixed_options(double order, int radius = 2) {
  return {.method = Method::fixed, .radius = radius, .order = order};
}

template <typename Real>
double texture_error(const GreyImage& image, const Plane<double>& csgv,
                     const Plane<double>& expected, int radius) {
  Plane<Real> texture = extract_texture<Real>(image, adaptive_options(radius)).texture;
  Plane<double> kept = expected;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (reference::is_at_branch_point(csgv.samples()[i])) {
      kept.samples()[i] = 0.0;
      texture.samples()[i] = Real{0};
    }
  }
  return largest_difference(texture, kept);
}

void check_adaptive(const GreyImage& image, int radius) {
  const Plane<double> csgv = reference::csgv(image);
  const Plane<double> expected = reference::texture(image, reference::order_map(csgv), radius);
  CHECK(texture_error<double>(image, csgv, expected, radius) < kDoubleTolerance);
  CHECK(texture_error<float>(image, csgv, expected, radius) < kFloatTolerance);
}

TEST_CASE("the adaptive texture agrees with its definition at every size and radius") {
  for (const Size size : awkward_sizes()) {
    for (const auto& [name, image] : example_images(size)) {
      for (const int radius : {1, 2, 3, 7, 20, ExtractionOptions::kMaxRadius}) {
        INFO(name << ", " << size.height << " x " << size.width << ", radius " << radius);
        check_adaptive(image, radius);
      }
    }
  }
}

TEST_CASE("the adaptive texture agrees with its definition on real stimulus sizes") {
  for (const Size size : stimulus_sizes()) {
    INFO(size.height << " x " << size.width);
    check_adaptive(cloth_image(size), 2);
    check_adaptive(noise_image(size), 7);
    check_adaptive(step_image(size), 3);
  }
}

TEST_CASE("the adaptive method gives its by-products in the image's shape") {
  const GreyImage image = cloth_image({9, 12});
  const auto result = extract_texture<double>(image, adaptive_options(), RequestedPlanes::all());
  const Plane<double> csgv = reference::csgv(image);
  CHECK(largest_relative_difference(result.csgv, csgv) < 1e-11);
  CHECK(largest_difference(result.order, reference::order_map(csgv)) < 1e-12);
  using reference::Tap;
  for (const auto& [band, expected] :
       {std::pair{&result.sub_band_ll, reference::sub_band(image, Tap::low, Tap::low)},
        std::pair{&result.sub_band_lh, reference::sub_band(image, Tap::low, Tap::high)},
        std::pair{&result.sub_band_hl, reference::sub_band(image, Tap::high, Tap::low)},
        std::pair{&result.sub_band_hh, reference::sub_band(image, Tap::high, Tap::high)}}) {
    CHECK(largest_relative_difference(*band, expected) < 1e-12);
  }
  for (std::size_t i = 0; i < image.size(); ++i) {
    REQUIRE(result.enhanced.samples()[i] == image.samples()[i] + result.texture.samples()[i]);
  }
  CHECK(result.cartoon.empty());
}

TEST_CASE("the fixed method uses one order for all pixels") {
  const GreyImage image = noise_image({13, 12});
  const auto result =
      extract_texture<double>(image, fixed_options(0.55, 3), RequestedPlanes::all());
  CHECK(result.order == Plane<double>(13, 12, 0.55));
  CHECK(largest_difference(result.texture, reference::texture(image, result.order, 3)) <
        kDoubleTolerance);
  CHECK(result.csgv.empty());
  CHECK(result.sub_band_ll.empty());
}

TEST_CASE("tv-gabor splits an image into cartoon and texture") {
  const GreyImage image = cloth_image({20, 24});
  ExtractionOptions options{.method = Method::tv_gabor};
  const auto result = extract_texture<double>(image, options, RequestedPlanes::all());
  CHECK(result.converged);
  CHECK(result.steps > 0);
  CHECK(result.gap <= options.tv_gabor.gap);
  for (std::size_t i = 0; i < image.size(); ++i) {
    REQUIRE(result.cartoon.samples()[i] + result.texture.samples()[i] ==
            Approx(image.samples()[i]).epsilon(1e-13));
  }
  CHECK(result.order.empty());
  CHECK(result.csgv.empty());
}

TEST_CASE("unwanted planes stay empty") {
  for (const Method method : {Method::adaptive, Method::fixed, Method::tv_gabor}) {
    ExtractionOptions options{.method = method};
    const auto result = extract_texture<float>(noise_image({8, 8}), options);
    CHECK(result.texture.size() == 64);
    for (const Plane<float>* plane :
         {&result.sub_band_ll, &result.sub_band_lh, &result.sub_band_hl, &result.sub_band_hh,
          &result.csgv, &result.order, &result.enhanced, &result.cartoon}) {
      CHECK(plane->empty());
    }
  }
}

TEST_CASE("extract_texture refuses an empty image, whatever the method") {
  for (const Method method : {Method::adaptive, Method::fixed, Method::tv_gabor}) {
    ExtractionOptions options{.method = method};
    CHECK_THAT(message_of<std::invalid_argument>(
                   [&] { (void)extract_texture<float>(GreyImage(), options); }),
               names("extract_texture"));
  }
}

template <typename Real>
int picture_of(Real texture) {
  return engine::texture_picture(Plane<Real>(1, 1, texture)).at(0, 0);
}

TEMPLATE_TEST_CASE("texture_picture rounds ties upwards, never to even", "", float, double) {
  CHECK(picture_of<TestType>(TestType(0.5)) == 129);
  CHECK(picture_of<TestType>(TestType(1.5)) == 130);
  CHECK(picture_of<TestType>(TestType(-0.5)) == 128);
  CHECK(picture_of<TestType>(TestType(-1.5)) == 127);
}

TEMPLATE_TEST_CASE("texture_picture clamps to what eight bits hold", "", float, double) {
  CHECK(picture_of<TestType>(TestType(-128.6)) == 0);
  CHECK(picture_of<TestType>(TestType(-1000)) == 0);
  CHECK(picture_of<TestType>(TestType(127)) == 255);
  CHECK(picture_of<TestType>(TestType(127.5)) == 255);
  CHECK(picture_of<TestType>(std::numeric_limits<TestType>::max()) == 255);
  CHECK(picture_of<TestType>(std::numeric_limits<TestType>::lowest()) == 0);
}

TEST_CASE("texture_picture does not round a float twice") {
  CHECK(picture_of(std::nextafter(0.5F, 0.0F)) == 128);
  CHECK(picture_of(std::nextafter(-0.5F, -1.0F)) == 127);
}

TEMPLATE_TEST_CASE("the mapping abs shows magnitudes, rounded half up", "", float, double) {
  Plane<TestType> texture(1, 4);
  texture.at(0, 0) = TestType(-3.5);
  texture.at(0, 1) = TestType(2.25);
  texture.at(0, 2) = TestType(-400);
  const GreyImage picture = engine::texture_picture(texture, Mapping::abs);
  CHECK(picture.at(0, 0) == 4);
  CHECK(picture.at(0, 1) == 2);
  CHECK(picture.at(0, 2) == 255);
  CHECK(picture.at(0, 3) == 0);
}

TEMPLATE_TEST_CASE("the mapping stretch fills 0 to 255, and shows a flat texture as 0", "", float,
                   double) {
  Plane<TestType> texture(1, 3);
  texture.at(0, 0) = TestType(-1);
  texture.at(0, 1) = TestType(1);
  texture.at(0, 2) = TestType(4);
  const GreyImage picture = engine::texture_picture(texture, Mapping::stretch);
  CHECK(picture.at(0, 0) == 0);
  CHECK(picture.at(0, 1) == 102);
  CHECK(picture.at(0, 2) == 255);
  CHECK(engine::texture_picture(Plane<TestType>(2, 3, TestType(7)), Mapping::stretch) ==
        GreyImage(2, 3));
}

TEST_CASE("texture_picture refuses an empty texture") {
  CHECK_THROWS_AS(engine::texture_picture(Plane<float>()), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

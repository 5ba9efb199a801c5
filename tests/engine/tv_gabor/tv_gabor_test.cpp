#include "engine/tv_gabor/tv_gabor.hpp"

#include "engine/example_images.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/tv_gabor_reference.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace touchtrial {
namespace {

engine::TvGaborOptions precise_options() {
  engine::TvGaborOptions options;
  options.gap = 1e-9;
  options.max_steps = 20000;
  return options;
}

/// Waves of the texture's frequency over a coarse step.
GreyImage striped_image(Size size) {
  GreyImage image(size.height, size.width);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double stripes = 30.0 * std::cos(1.6 * x) + 20.0 * std::cos(1.5 * y);
      image.at(y, x) = static_cast<std::uint8_t>((y < size.height / 2 ? 80.0 : 150.0) + stripes);
    }
  }
  return image;
}

TEST_CASE("tv_gabor agrees with accelerated projected gradient on the dual") {
  for (const GreyImage& image : {striped_image({10, 10}), noise_image({2, 3})}) {
    const engine::TvGaborOptions options = precise_options();
    const engine::TvGaborResult<double> result = engine::tv_gabor<double>(image, options);
    const reference::TvGabor definition(image, options);
    const Plane<double> expected = definition.cropped(definition.texture(definition.fista(2000)));
    CHECK(result.converged);
    CHECK(distance_relative_to(result.texture, expected) < 1e-4);
    CHECK(largest_difference(result.texture, expected) < 1e-2);
  }
}

TEST_CASE("tv_gabor takes any components and lambda") {
  engine::TvGaborOptions options = precise_options();
  options.lambda = 0.05;
  options.components = {{0.2, 30.0}, {0.4, 120.0}};
  const GreyImage image = striped_image({8, 10});
  const reference::TvGabor definition(image, options);
  const Plane<double> expected = definition.cropped(definition.texture(definition.fista(2000)));
  CHECK(distance_relative_to(engine::tv_gabor<double>(image, options).texture, expected) < 1e-4);
}

TEMPLATE_TEST_CASE("tv_gabor of a flat image is zero with gap zero and no steps", "", float,
                   double) {
  for (const Size size : {Size{1, 1}, Size{3, 5}, Size{40, 40}}) {
    const engine::TvGaborResult<TestType> result =
        engine::tv_gabor<TestType>(flat_image(size, 77), {});
    CHECK(largest_magnitude(result.texture) == 0.0);
    CHECK(result.cartoon == Plane<TestType>(size.height, size.width, TestType{77}));
    CHECK(result.gap == 0.0);
    CHECK(result.steps == 0);
    CHECK(result.converged);
  }
}

TEMPLATE_TEST_CASE("tv_gabor gives cartoon plus texture the image's shape and levels", "", float,
                   double) {
  for (const Size size : {Size{1, 9}, Size{9, 1}, Size{2, 2}, Size{5, 7}, Size{64, 63}}) {
    const GreyImage image = noise_image(size);
    const engine::TvGaborResult<TestType> result = engine::tv_gabor<TestType>(image, {});
    Plane<TestType> sum = result.cartoon;
    REQUIRE(sum.size() == result.texture.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum.samples()[i] += result.texture.samples()[i];
    }
    CHECK(largest_difference(sum, image) < 1e-4);
    CHECK(result.gap >= 0.0);
    CHECK(result.gap <= 1e-5);
  }
}

TEST_CASE("tv_gabor sees texture in stripes of its frequency and little in a broad edge") {
  GreyImage stripes(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) stripes.at(y, x) = (x / 2) % 2 == 0 ? 100 : 160;
  }
  const auto striped = engine::tv_gabor<double>(stripes, {});
  CHECK(largest_magnitude(striped.texture) > 25.0);
  engine::TvGaborOptions options;
  options.gap = 1e-3;
  const auto edge = engine::tv_gabor<double>(step_image({64, 64}, 100, 160), options);
  CHECK(largest_magnitude(edge.texture) < 2.0);
}

TEST_CASE("tv_gabor in float finds the texture that double finds") {
  for (const GreyImage& image : {noise_image({90, 81}), cloth_image({90, 81})}) {
    const auto exact = engine::tv_gabor<double>(image, {});
    const auto single = engine::tv_gabor<float>(image, {});
    CHECK(exact.converged);
    CHECK(single.converged);
    CHECK(distance_relative_to(single.texture, exact.texture) < 1e-3);
  }
}

TEST_CASE("tv_gabor in float goes on in double where float's digits end") {
  engine::TvGaborOptions options;
  options.gap = 1e-8;
  const auto result = engine::tv_gabor<float>(noise_image({40, 41}), options);
  CHECK(result.converged);
  CHECK(result.gap <= 1e-8);
  CHECK(distance_relative_to(result.texture,
                             engine::tv_gabor<double>(noise_image({40, 41}), options).texture) <
        1e-4);
}

TEST_CASE("tv_gabor gives the same samples every time") {
  const GreyImage image = cloth_image({30, 31});
  CHECK(engine::tv_gabor<float>(image, {}).texture == engine::tv_gabor<float>(image, {}).texture);
}

TEST_CASE("tv_gabor of a negative is the negative texture") {
  const GreyImage image = cloth_image({40, 41});
  auto negative = engine::tv_gabor<double>(negative_of(image), {}).texture;
  for (double& sample : negative.samples()) sample = -sample;
  CHECK(distance_relative_to(negative, engine::tv_gabor<double>(image, {}).texture) < 1e-9);
}

TEST_CASE("tv_gabor that runs out of steps says so and gives what it has") {
  engine::TvGaborOptions options;
  options.max_steps = 3;
  const auto result = engine::tv_gabor<double>(cloth_image({40, 41}), options);
  CHECK_FALSE(result.converged);
  CHECK(result.steps == 3);
  CHECK(result.gap > options.gap);
  CHECK(largest_magnitude(result.texture) > 0.0);
}

TEMPLATE_TEST_CASE("tv_gabor stays finite at the ends of lambda's range", "", float, double) {
  for (const double lambda :
       {engine::TvGaborOptions::kMinLambda, engine::TvGaborOptions::kMaxLambda}) {
    engine::TvGaborOptions options;
    options.lambda = lambda;
    options.max_steps = 300;
    const auto result = engine::tv_gabor<TestType>(noise_image({20, 20}), options);
    CHECK(std::isfinite(largest_magnitude(result.texture)));
    CHECK(std::isfinite(result.gap));
  }
}

TEST_CASE("tv_gabor refuses an empty image") {
  CHECK_THROWS_AS(engine::tv_gabor<float>(GreyImage(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

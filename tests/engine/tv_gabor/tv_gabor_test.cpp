#include "engine/tv_gabor/tv_gabor.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/tv_gabor_fixed_point.hpp"
#include "engine/reference/tv_gabor_reference.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace touchtrial {
namespace {

using namespace engine;

TvGaborOptions precise_options() {
  return {.gap = 1e-9, .max_steps = 20000};
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
    const TvGaborOptions options = precise_options();
    const TvGaborResult<double> result = tv_gabor<double>(image, options);
    const reference::TvGabor definition(image, options);
    const Plane<double> expected = definition.cropped(definition.texture(definition.fista(2000)));
    CHECK(result.converged);
    CHECK(distance_relative_to(result.texture, expected) < 1e-4);
    CHECK(largest_difference(result.texture, expected) < 1e-2);
  }
}

TEST_CASE("the fixed point on the engine's transforms takes the steps that define it") {
  const GreyImage image = cloth_image({6, 9});
  const reference::TvGabor definition(image, {});
  const Plane<double> expected = definition.cropped(definition.texture(definition.fixed_point(30)));
  CHECK(distance_relative_to(reference::tv_gabor_fixed_point(image, {}, 30), expected) < 1e-4);
}

TEST_CASE("tv_gabor takes any components and lambda") {
  TvGaborOptions options = precise_options();
  options.lambda = 0.05;
  options.components = {{0.2, 30.0}, {0.4, 120.0}};
  const GreyImage image = striped_image({8, 10});
  const reference::TvGabor definition(image, options);
  const Plane<double> expected = definition.cropped(definition.texture(definition.fista(2000)));
  CHECK(distance_relative_to(tv_gabor<double>(image, options).texture, expected) < 1e-4);
}

TEMPLATE_TEST_CASE("tv_gabor of a flat image is zero with gap zero and no steps", "", float,
                   double) {
  for (const Size size : {Size{1, 1}, Size{3, 5}, Size{40, 40}}) {
    const TvGaborResult<TestType> result = tv_gabor<TestType>(flat_image(size, 77), {});
    CHECK(largest_magnitude(result.texture) == 0.0);
    CHECK(result.cartoon == Plane<TestType>(size.height, size.width, TestType{77}));
    CHECK(result.gap == 0.0);
    CHECK(result.steps == 0);
    CHECK(result.converged);
  }
}

TEST_CASE("tv_gabor in float finds the texture that double finds") {
  for (const GreyImage& image : {noise_image({90, 81}), cloth_image({90, 81})}) {
    const auto exact = tv_gabor<double>(image, {});
    const auto single = tv_gabor<float>(image, {});
    CHECK(exact.converged);
    CHECK(single.converged);
    CHECK(distance_relative_to(single.texture, exact.texture) < 1e-3);
  }
}

TEST_CASE("tv_gabor in float continues in double where float's digits end") {
  TvGaborOptions options{.gap = 1e-8};
  const auto result = tv_gabor<float>(noise_image({40, 41}), options);
  CHECK(result.converged);
  CHECK(result.gap <= 1e-8);
  CHECK(distance_relative_to(result.texture,
                             tv_gabor<double>(noise_image({40, 41}), options).texture) < 1e-4);
}

TEMPLATE_TEST_CASE("TV-Gabor's result is the same for any number of jobs", "", float, double) {
  const GreyImage image = cloth_image({180, 70});
  TvGaborOptions options{.gap = 1e-300};
  TvGaborSolver<TestType> alone(image, options, 1), two(image, options, 2), all(image, options, 0);
  // Past the checks that need no residuals.
  for (auto* const solver : {&alone, &two, &all}) {
    CHECK(solver->run(230, Patience::unlimited) == SolverStop::exhausted);
  }
  for (auto* const solver : {&two, &all}) {
    CHECK(solver->texture() == alone.texture());
    CHECK(solver->gap() == alone.gap());
    CHECK(solver->state().z.x == alone.state().z.x);
    CHECK(solver->state().z.y == alone.state().z.y);
    CHECK(solver->state().penalty == alone.state().penalty);
  }
}

TEST_CASE("tv_gabor that runs out of steps says so and returns its last texture") {
  TvGaborOptions options{.max_steps = 3};
  const auto result = tv_gabor<double>(cloth_image({40, 41}), options);
  CHECK_FALSE(result.converged);
  CHECK(result.steps == 3);
  CHECK(result.gap > options.gap);
  CHECK(largest_magnitude(result.texture) > 0.0);
}

/// 128 + 60 cos, of a wave along `direction_deg`.
GreyImage wave(Size size, double frequency, double direction_deg) {
  const double direction = direction_deg * std::numbers::pi / 180.0;
  GreyImage image(size.height, size.width);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double along = x * std::cos(direction) + y * std::sin(direction);
      const double level = 128.0 + 60.0 * std::cos(2.0 * std::numbers::pi * frequency * along);
      image.at(y, x) = static_cast<std::uint8_t>(std::lround(level));
    }
  }
  return image;
}

/// The power of the windowed image at one frequency, by its definition.
double power_at(const GreyImage& image, double fx, double fy) {
  double mean = 0.0;
  for (const std::uint8_t sample : image.samples()) mean += sample;
  mean /= static_cast<double>(image.size());
  std::complex<double> sum = 0.0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double wy = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (y + 0.5) / image.height());
      const double wx = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (x + 0.5) / image.width());
      sum += wy * wx * (image.at(y, x) - mean) *
             std::polar(1.0, -2.0 * std::numbers::pi * (fx * x + fy * y));
    }
  }
  return std::norm(sum);
}

TEST_CASE("the strongest component of a wave is the wave") {
  for (const double direction : {0.0, 90.0}) {
    const GaborComponent found = engine::strongest_component(wave({100, 100}, 0.2, direction));
    CHECK(found.frequency_cycles_per_px == Approx(0.2));
    CHECK(found.direction_deg == Approx(direction));
  }
  for (const double direction : {30.0, 45.0, 150.0}) {
    const GaborComponent found = engine::strongest_component(wave({128, 160}, 0.3, direction));
    CHECK(found.frequency_cycles_per_px == Approx(0.3).margin(0.006));
    CHECK(found.direction_deg == Approx(direction).margin(1.5));
  }
}

TEST_CASE("shading below 0.04 cycles per pixel is not taken for texture") {
  GreyImage image = wave({200, 200}, 0.02, 0.0);
  const GreyImage ripple = wave({200, 200}, 0.25, 90.0);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.samples()[i] =
        static_cast<std::uint8_t>(image.samples()[i] / 2 + ripple.samples()[i] / 4);
  }
  const GaborComponent found = engine::strongest_component(image);
  CHECK(found.frequency_cycles_per_px == Approx(0.25));
  CHECK(found.direction_deg == Approx(90.0));
}

TEST_CASE("no frequency of the grid within the range is stronger than the strongest") {
  for (const Size size : {Size{16, 21}, Size{15, 16}, Size{3, 3}, Size{1, 12}}) {
    const GreyImage image = cloth_image(size);
    const GaborComponent found = engine::strongest_component(image);
    const double direction = found.direction_deg * std::numbers::pi / 180.0;
    const double most = power_at(image, found.frequency_cycles_per_px * std::cos(direction),
                                 found.frequency_cycles_per_px * std::sin(direction));
    for (int ky = -size.height / 2; ky <= size.height / 2; ++ky) {
      for (int kx = 0; kx <= size.width / 2; ++kx) {
        const double fy = static_cast<double>(ky) / size.height;
        const double fx = static_cast<double>(kx) / size.width;
        if (std::hypot(fx, fy) < 0.04 || std::hypot(fx, fy) > 0.45) continue;
        CHECK(power_at(image, fx, fy) <= most * (1.0 + 1e-9) + 1e-9);
      }
    }
  }
}

TEST_CASE("an image without any frequency in the range is refused") {
  for (const Size size : {Size{1, 1}, Size{2, 2}, Size{1, 2}}) {
    CHECK_THAT(message_of<std::invalid_argument>(
                   [&] { (void)engine::strongest_component(noise_image(size)); }),
               names("components 3"));
  }
  CHECK_FALSE(message_of<std::invalid_argument>([] {
                (void)engine::strongest_component(GreyImage());
              }).empty());
}

TEST_CASE("automatic tv-gabor is tv-gabor with the strongest component, and says which") {
  const GreyImage image = wave({48, 40}, 0.2, 0.0);
  ExtractionOptions automatic{.method = Method::tv_gabor};
  automatic.tv_gabor.automatic = true;
  automatic.tv_gabor.components.clear();
  ExtractionOptions listed = automatic;
  listed.tv_gabor.automatic = false;
  listed.tv_gabor.components = {engine::strongest_component(image)};
  const auto result = extract_texture<double>(image, automatic);
  CHECK(result.components == listed.tv_gabor.components);
  CHECK(result.texture == extract_texture<double>(image, listed).texture);
  const auto flat = extract_texture<double>(flat_image({2, 2}, 9), automatic);
  CHECK(largest_magnitude(flat.texture) == 0.0);
  CHECK(flat.components.empty());
}

}  // namespace
}  // namespace touchtrial

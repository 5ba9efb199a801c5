#include "engine/rendering/texture_field.hpp"

#include "engine/force_field.hpp"
#include "engine/gaussian_filter.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

TEST_CASE("make_texture_field carries the texture's shape and the options' pitch") {
  engine::RenderingOptions options{.pitch_mm = 0.25};
  const engine::TextureField field = engine::make_texture_field(random_texture(3, 7, 1), options);
  CHECK(field.view().geometry.height_px == 3);
  CHECK(field.view().geometry.width_px == 7);
  CHECK(field.view().geometry.pitch_mm == 0.25);
}

TEST_CASE("make_texture_field is the force of the filtered surface") {
  engine::RenderingOptions options{.pitch_mm = 0.1, .filter_mm = 0.15, .neighbourhood = 5};
  const Plane<double> texture = random_texture(17, 12, 2);
  const Plane<double> surface = engine::gaussian_filtered(texture, 1.5);
  const engine::ForceField<double> force = engine::tangential_force(surface, 5);
  const engine::TextureField field = engine::make_texture_field(texture, options);
  const engine::SampledField samples = sampled(field.view());
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const engine::FieldSample sample = samples.samples.samples()[i];
    REQUIRE(sample.height == Approx(surface.samples()[i]).epsilon(1e-6));
    REQUIRE(sample.force_x == Approx(force.x.samples()[i]).epsilon(1e-6).margin(1e-5));
    REQUIRE(sample.force_y == Approx(force.y.samples()[i]).epsilon(1e-6).margin(1e-5));
  }
}

TEST_CASE("the force of stored heights is that of the exact ones, to 3e-7 of the largest height") {
  const double amplitude = GENERATE(1e-3, 40.0, 255.0);
  const Plane<double> texture = random_texture(60, 70, 5, amplitude);
  engine::RenderingOptions options{.filter_mm = GENERATE(0.0, 0.4),
                                   .neighbourhood = GENERATE(3, 7)};
  const Plane<double> smooth =
      engine::gaussian_filtered(texture, to_px(options.filter_mm, options.pitch_mm));
  const engine::ForceField<double> exact = engine::tangential_force(smooth, options.neighbourhood);
  const engine::TextureField field = engine::make_texture_field(texture, options);
  const engine::ForceField<double> stored = engine::lateral_field(field.view(), {}).force;
  double largest = 0.0;
  double error = 0.0;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    largest = std::max(largest, std::abs(smooth.samples()[i]));
    error = std::max({error, std::abs(stored.x.samples()[i] - exact.x.samples()[i]),
                      std::abs(stored.y.samples()[i] - exact.y.samples()[i])});
  }
  CAPTURE(amplitude, options.neighbourhood);
  CHECK(error > 0.0);
  CHECK(error <= 3e-7 * largest * (options.neighbourhood / 2));
}

TEST_CASE("make_texture_field takes the smallest images") {
  const engine::TextureField pixel = engine::make_texture_field(random_texture(1, 1, 3), {});
  CHECK(sampled(pixel.view()).samples.at(0, 0).force_x == 0.0F);
  CHECK(engine::make_texture_field(random_texture(1, 9, 3), {}).view().heights.size() == 9);
}

TEST_CASE("make_texture_field refuses an empty texture and impossible options") {
  const Plane<double> texture = random_texture(4, 4, 4);
  CHECK_THROWS_AS(engine::make_texture_field(Plane<double>(), {}), std::invalid_argument);
  const auto with = [](double pitch_mm, double filter_mm, int neighbourhood) {
    engine::RenderingOptions options{
        .pitch_mm = pitch_mm, .filter_mm = filter_mm, .neighbourhood = neighbourhood};
    return options;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(engine::make_texture_field(texture, with(0.0, 0.4, 3)), std::invalid_argument);
  CHECK_THROWS_AS(engine::make_texture_field(texture, with(infinity, 0.4, 3)),
                  std::invalid_argument);
  CHECK_THROWS_AS(engine::make_texture_field(texture, with(0.2, -0.1, 3)), std::invalid_argument);
  CHECK_THROWS_AS(engine::make_texture_field(texture, with(0.2, infinity, 3)),
                  std::invalid_argument);
  CHECK_THROWS_AS(engine::make_texture_field(texture, with(0.2, 0.4, 4)), std::invalid_argument);
  CHECK_THROWS_AS(engine::make_texture_field(texture, with(0.2, 0.4, 1)), std::invalid_argument);
  CHECK_THROWS_AS(engine::make_texture_field(texture, with(0.2, 0.4, 33)), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

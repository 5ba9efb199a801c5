#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace touchtrial {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string refusal_of_options(const engine::ExtractionOptions& options) {
  return refusal_of([&] { engine::check_options(options); });
}

std::string refusal_of_tv_gabor(const engine::TvGaborOptions& tv_gabor) {
  engine::ExtractionOptions options;
  options.method = engine::Method::tv_gabor;
  options.tv_gabor = tv_gabor;
  return refusal_of_options(options);
}

TEST_CASE("an order that is negative, 1 or more is refused by name") {
  for (const double order : {kNan, kInfinity, -kInfinity, 1.0, -1.0, -1e-12, 1e300}) {
    engine::ExtractionOptions options;
    options.method = engine::Method::fixed;
    options.order = order;
    INFO("order " << order);
    CHECK(refusal_of_options(options).starts_with("order: must be in [0, 1), not "));
    CHECK_FALSE(refusal_of([&] {
                  (void)engine::extract_texture<double>(noise_image({4, 4}), options);
                }).empty());
  }
}

TEST_CASE("a radius outside 1 to 63 is refused by name") {
  for (const engine::Method method : {engine::Method::adaptive, engine::Method::fixed}) {
    for (const int radius : {-1, 0, 64, std::numeric_limits<int>::max()}) {
      engine::ExtractionOptions options;
      options.method = method;
      options.radius = radius;
      CHECK(refusal_of_options(options) ==
            "radius: must be from 1 to 63, not " + std::to_string(radius));
    }
  }
}

TEST_CASE("the ends of every range are accepted") {
  engine::ExtractionOptions options;
  options.method = engine::Method::fixed;
  options.order = 0.0;
  options.radius = 1;
  CHECK(refusal_of_options(options).empty());
  options.order = std::nextafter(1.0, 0.0);
  options.radius = engine::ExtractionOptions::kMaxRadius;
  CHECK(refusal_of_options(options).empty());
  engine::TvGaborOptions tv_gabor;
  tv_gabor.lambda = engine::TvGaborOptions::kMinLambda;
  tv_gabor.components = {{0.5, -720.0}};
  tv_gabor.max_steps = 1;
  CHECK(refusal_of_tv_gabor(tv_gabor).empty());
  tv_gabor.lambda = engine::TvGaborOptions::kMaxLambda;
  CHECK(refusal_of_tv_gabor(tv_gabor).empty());
}

TEST_CASE("a lambda that is not positive and finite is refused by name") {
  for (const double lambda : {kNan, kInfinity, 0.0, -0.01, 1e-7, 1e7}) {
    engine::TvGaborOptions options;
    options.lambda = lambda;
    INFO("lambda " << lambda);
    CHECK(refusal_of_tv_gabor(options).starts_with("lambda: must be from 1e-6 to 1e6, not "));
  }
}

TEST_CASE("a stop that cannot be reached is refused by name") {
  for (const double gap : {kNan, kInfinity, 0.0, -1e-5}) {
    engine::TvGaborOptions options;
    options.gap = gap;
    INFO("gap " << gap);
    CHECK(refusal_of_tv_gabor(options).starts_with("gap:"));
  }
  for (const int max_steps : {0, -5}) {
    engine::TvGaborOptions options;
    options.max_steps = max_steps;
    CHECK(refusal_of_tv_gabor(options).starts_with("max_steps:"));
  }
}

TEST_CASE("a component that is no oscillation is refused by name") {
  engine::TvGaborOptions options;
  options.components = {};
  CHECK(refusal_of_tv_gabor(options).starts_with("components:"));
  for (const double frequency : {kNan, 0.0, -0.25, 0.51, kInfinity}) {
    options.components = {{0.25, 0.0}, {frequency, 0.0}};
    INFO("frequency " << frequency);
    CHECK(refusal_of_tv_gabor(options).starts_with("frequency_cycles_per_px:"));
  }
  for (const double direction : {kNan, kInfinity}) {
    options.components = {{0.25, direction}};
    CHECK(refusal_of_tv_gabor(options).starts_with("direction_deg:"));
  }
}

TEST_CASE("options of other methods are not looked at") {
  engine::ExtractionOptions options;
  options.order = kNan;
  options.tv_gabor.lambda = kNan;
  CHECK(refusal_of_options(options).empty());
  options = {};
  options.method = engine::Method::tv_gabor;
  options.radius = 0;
  CHECK(refusal_of_options(options).empty());
}

}  // namespace
}  // namespace touchtrial

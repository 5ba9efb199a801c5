#include "engine/extraction_options.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/gl_texture.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

TEST_CASE("methods have the names that study files use") {
  CHECK(engine::method_names() == std::vector<std::string>{"adaptive", "fixed", "tv-gabor",
                                                           "gaussian", "median", "edge",
                                                           "luminance"});
  for (const std::string& name : engine::method_names()) {
    const auto method = engine::method_from_name(name);
    REQUIRE(method.has_value());
    CHECK(engine::name_of(*method) == name);
  }
  CHECK_FALSE(engine::method_from_name("tv_gabor").has_value());
  CHECK_FALSE(engine::method_from_name("").has_value());
}

TEST_CASE("a parameter belongs to the methods that use it, in the order of the enumeration") {
  using engine::Method;
  using engine::Parameter;
  CHECK(engine::methods_with(Parameter::radius) ==
        std::vector{Method::adaptive, Method::fixed, Method::median});
  CHECK(engine::methods_with(Parameter::norm) == std::vector{Method::adaptive, Method::fixed});
  CHECK(engine::methods_with(Parameter::divisor) == std::vector{Method::edge});
  CHECK(engine::methods_with(Parameter::max_steps) == std::vector{Method::tv_gabor});
}

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

TEST_CASE("a gap or number of steps that cannot be reached is refused by name") {
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

TEST_CASE("an invalid component is refused by name") {
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

TEST_CASE("parameters of other methods are ignored") {
  engine::ExtractionOptions options;
  options.order = kNan;
  options.tv_gabor.lambda = kNan;
  CHECK(refusal_of_options(options).empty());
  options = {};
  options.method = engine::Method::tv_gabor;
  options.radius = 0;
  CHECK(refusal_of_options(options).empty());
}

// The norms, gradients, combinations and levels of the adaptive and the fixed method.

engine::ExtractionOptions fixed_with(engine::Norm norm, double order, int radius = 2) {
  engine::ExtractionOptions options;
  options.method = engine::Method::fixed;
  options.norm = norm;
  options.order = order;
  options.radius = radius;
  return options;
}

engine::ExtractionOptions adaptive_with(int levels, engine::Gradient gradient,
                                        engine::Combine combine) {
  engine::ExtractionOptions options;
  options.levels = levels;
  options.gradient = gradient;
  options.combine = combine;
  return options;
}

void check_csgv(const GreyImage& image, int levels, engine::Gradient gradient,
                engine::Combine combine) {
  const engine::WantedPlanes wanted{.csgv = true, .order = true};
  const auto result =
      engine::extract_texture<double>(image, adaptive_with(levels, gradient, combine), wanted);
  const Plane<double> expected =
      reference::csgv(image, levels, std::string(name_in(engine::kGradientNames, gradient)),
                      std::string(name_in(engine::kCombineNames, combine)));
  CHECK(largest_relative_difference(result.csgv, expected) < 1e-10);  // ll grows by 2 a level
  CHECK(largest_difference(result.order, reference::order_map(result.csgv)) < 1e-12);
  CHECK(largest_difference(result.texture, reference::texture(image, result.order, 2)) < 1e-10);
}

TEST_CASE("every gradient and combination agrees with its definition at every level") {
  for (const Size size : {Size{1, 1}, Size{2, 3}, Size{9, 12}, Size{33, 47}}) {
    for (const int levels : {1, 2, 3, engine::ExtractionOptions::kMaxLevels}) {
      for (const engine::Gradient gradient :
           {engine::Gradient::sobel, engine::Gradient::prewitt, engine::Gradient::central}) {
        for (const engine::Combine combine :
             {engine::Combine::sum, engine::Combine::l2, engine::Combine::max}) {
          INFO(size.height << " x " << size.width << ", levels " << levels << ", "
                           << name_in(engine::kGradientNames, gradient) << ", "
                           << name_in(engine::kCombineNames, combine));
          check_csgv(cloth_image(size), levels, gradient, combine);
        }
      }
    }
  }
}

TEST_CASE("a flat image stays exactly flat under every option") {
  const GreyImage image = flat_image({11, 14}, 201);
  for (const int levels : {1, 3}) {
    for (const engine::Gradient gradient :
         {engine::Gradient::sobel, engine::Gradient::prewitt, engine::Gradient::central}) {
      for (const engine::Norm norm :
           {engine::Norm::additive, engine::Norm::sum, engine::Norm::none}) {
        engine::ExtractionOptions options = adaptive_with(levels, gradient, engine::Combine::l2);
        options.norm = norm;
        CHECK(largest_magnitude(engine::extract_texture<float>(image, options).texture) == 0.0);
      }
    }
  }
  CHECK(largest_magnitude(
            engine::extract_texture<double>(image, fixed_with(engine::Norm::sum, 0.999)).texture) ==
        0.0);
  CHECK(largest_magnitude(
            engine::extract_texture<double>(image, fixed_with(engine::Norm::none, 0.3)).texture) ==
        0.0);
}

TEST_CASE("every norm agrees with its definition at fixed orders") {
  const GreyImage image = cloth_image({23, 30});
  for (const auto& [norm, name] :
       {std::pair{engine::Norm::additive, "additive"}, std::pair{engine::Norm::sum, "sum"},
        std::pair{engine::Norm::none, "none"}}) {
    for (const double order : {0.0, 1e-300, 0.05, 0.5, 0.999}) {
      for (const int radius : {1, 2, 7, 40}) {
        INFO(name << ", order " << order << ", radius " << radius);
        const Plane<double> orders(23, 30, order);
        const Plane<double> expected = reference::texture(image, orders, radius, name);
        const double gain =
            norm == engine::Norm::sum ? 1.0 / engine::gl_weight_sum(order, radius) : 1.0;
        const auto options = fixed_with(norm, order, radius);
        CHECK(largest_difference(engine::extract_texture<double>(image, options).texture,
                                 expected) < 1e-11 * std::max(gain, 1.0));
      }
    }
  }
}

TEST_CASE("every norm agrees with its definition at adaptive orders") {
  const GreyImage image = cloth_image({41, 30});
  for (const auto& [norm, name] :
       {std::pair{engine::Norm::sum, "sum"}, std::pair{engine::Norm::none, "none"}}) {
    engine::ExtractionOptions options;
    options.norm = norm;
    const auto result =
        engine::extract_texture<double>(image, options, engine::WantedPlanes::all());
    CHECK(largest_difference(result.texture, reference::texture(image, result.order, 2, name)) <
          1e-8);
  }
}

TEST_CASE("float textures of other norms are the double ones rounded") {
  const GreyImage image = noise_image({40, 31});
  for (const engine::Norm norm : {engine::Norm::sum, engine::Norm::none}) {
    for (const double order : {0.3, 0.999, std::nextafter(1.0, 0.0)}) {
      const auto options = fixed_with(norm, order);
      const auto exact = engine::extract_texture<double>(image, options).texture;
      CHECK(engine::extract_texture<float>(image, options).texture == converted<float>(exact));
    }
  }
}

TEST_CASE("the sum norm is the classical mask") {
  // 8 - 12 v + 4 v^2 is eight times its sum at radius 2.
  const double v = 0.4;
  GreyImage impulse(9, 9);
  impulse.at(4, 4) = 255;
  const auto texture =
      engine::extract_texture<double>(impulse, fixed_with(engine::Norm::sum, v)).texture;
  const double sum = 8.0 - 12.0 * v + 4.0 * v * v;
  CHECK(texture.at(4, 4) == Approx(255.0 * (8.0 / sum - 1.0)));
  CHECK(texture.at(4, 5) == Approx(255.0 * -v / sum));
  CHECK(texture.at(2, 6) == Approx(255.0 * 0.5 * (v * v - v) / sum));
}

TEST_CASE("a number of levels outside 1 to 8 is refused by name") {
  for (const int levels : {0, -1, 9, std::numeric_limits<int>::max()}) {
    const auto options = adaptive_with(levels, engine::Gradient::sobel, engine::Combine::sum);
    CHECK_THROWS_WITH(engine::check_options(options),
                      "levels: must be from 1 to 8, not " + std::to_string(levels));
  }
}

TEST_CASE("words are found for values, and values for words") {
  CHECK(value_in(engine::kNormNames, "sum") == engine::Norm::sum);
  CHECK(value_in(engine::kMappingNames, "stretch") == engine::Mapping::stretch);
  CHECK(value_in(engine::kGradientNames, "central") == engine::Gradient::central);
  CHECK(value_in(engine::kCombineNames, "l2") == engine::Combine::l2);
  CHECK_FALSE(value_in(engine::kNormNames, "l2").has_value());
  CHECK(name_in(engine::kGradientNames, engine::Gradient::prewitt) == "prewitt");
}

}  // namespace
}  // namespace touchtrial

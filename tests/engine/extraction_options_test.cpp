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
#include <functional>
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
constexpr double kLargestInt = std::numeric_limits<int>::max();

std::string refusal_of_options(const engine::ExtractionOptions& options) {
  return refusal_of([&] { engine::check_options(options); });
}

std::string refusal_of_tv_gabor(const engine::TvGaborOptions& tv_gabor) {
  engine::ExtractionOptions options;
  options.method = engine::Method::tv_gabor;
  options.tv_gabor = tv_gabor;
  return refusal_of_options(options);
}

/// A parameter of a method, and values that it cannot have besides those that are not finite.
struct Refused {
  std::string name;
  engine::Method method;
  std::function<void(engine::ExtractionOptions&, double)> set;
  std::vector<double> values;
  bool is_whole = false;
};

std::vector<Refused> refused_options() {
  using engine::Method;
  using Options = engine::ExtractionOptions;
  const auto radius = [](Options& o, double value) { o.radius = static_cast<int>(value); };
  const std::vector<double> radii = {-1.0, 0.0, 64.0, kLargestInt};
  return {
      {"order",
       Method::fixed,
       [](Options& o, double value) { o.order = value; },
       {1.0, -1.0, -1e-12, -1e-300, 1.0 + 1e-15, 1e300}},
      {"radius", Method::adaptive, radius, radii, true},
      {"radius", Method::fixed, radius, radii, true},
      {"radius", Method::median, radius, radii, true},
      {"levels",
       Method::adaptive,
       [](Options& o, double value) { o.levels = static_cast<int>(value); },
       {0.0, -1.0, 9.0, kLargestInt},
       true},
      {"sigma",
       Method::gaussian,
       [](Options& o, double value) { o.sigma_px = value; },
       {0.0, -1.0, 1001.0}},
      {"threshold",
       Method::median,
       [](Options& o, double value) { o.threshold_grey = value; },
       {-0.1, 256.0}},
      {"divisor",
       Method::edge,
       [](Options& o, double value) { o.divisor = value; },
       {0.0, -4.0, 1e7}},
      {"lambda",
       Method::tv_gabor,
       [](Options& o, double value) { o.tv_gabor.lambda = value; },
       {0.0, -0.01, 1e-7, 1e7}},
      {"gap",
       Method::tv_gabor,
       [](Options& o, double value) { o.tv_gabor.gap = value; },
       {0.0, -1e-5}},
      {"max_steps",
       Method::tv_gabor,
       [](Options& o, double value) { o.tv_gabor.max_steps = static_cast<int>(value); },
       {0.0, -5.0},
       true},
      {"frequency_cycles_per_px",
       Method::tv_gabor,
       [](Options& o, double value) {
         o.tv_gabor.components = {{0.25, 0.0}, {value, 0.0}};
       },
       {0.0, -0.25, 0.51}},
      {"direction_deg",
       Method::tv_gabor,
       [](Options& o, double value) {
         o.tv_gabor.components = {{0.25, value}};
       },
       {}},
  };
}

TEST_CASE("a parameter that is not finite or out of its range is refused by name") {
  for (Refused one : refused_options()) {
    if (!one.is_whole) one.values.insert(one.values.end(), {kNan, kInfinity, -kInfinity});
    for (const double value : one.values) {
      INFO(one.name << " " << value);
      engine::ExtractionOptions options;
      options.method = one.method;
      one.set(options, value);
      CHECK(refusal_of_options(options).starts_with(one.name + ":"));
      CHECK_THAT(refusal_of([&] {
                   (void)engine::extract_texture<float>(noise_image({4, 4}), options);
                 }),
                 holds_text(one.name + ":"));
    }
  }
  engine::TvGaborOptions none;
  none.components = {};
  CHECK(refusal_of_tv_gabor(none).starts_with("components:"));
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

}  // namespace
}  // namespace touchtrial

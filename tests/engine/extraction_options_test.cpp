#include "engine/extraction_options.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/gl_texture.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using namespace engine;

TEST_CASE("methods have the names that study files use") {
  CHECK(method_names() == std::vector<std::string>{"adaptive", "fixed", "tv-gabor", "gaussian",
                                                   "median", "edge", "luminance"});
  for (const std::string& name : method_names()) {
    const auto method = method_from_name(name);
    REQUIRE(method.has_value());
    CHECK(name_of(*method) == name);
  }
  CHECK_FALSE(method_from_name("tv_gabor").has_value());
  CHECK_FALSE(method_from_name("").has_value());
}

TEST_CASE("a parameter belongs to the methods that use it, in the order of the enumeration") {
  CHECK(methods_with(Parameter::radius) ==
        std::vector{Method::adaptive, Method::fixed, Method::median});
  CHECK(methods_with(Parameter::norm) == std::vector{Method::adaptive, Method::fixed});
  CHECK(methods_with(Parameter::divisor) == std::vector{Method::edge});
  CHECK(methods_with(Parameter::max_steps) == std::vector{Method::tv_gabor});
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMaxInt = std::numeric_limits<int>::max();

std::string refusal_of_options(const ExtractionOptions& options) {
  return message_of<std::invalid_argument>([&] { check_options(options); });
}

std::string refusal_of_tv_gabor(const TvGaborOptions& tv_gabor) {
  ExtractionOptions options{.method = Method::tv_gabor, .tv_gabor = tv_gabor};
  return refusal_of_options(options);
}

/// A parameter of a method, and values that it cannot have besides those that are not finite.
struct Refused {
  std::string name;
  Method method;
  std::function<void(ExtractionOptions&, double)> set;
  std::vector<double> values;
  bool is_whole = false;
};

std::vector<Refused> refused_options() {
  using Options = ExtractionOptions;
  const auto radius = [](Options& o, double value) { o.radius = static_cast<int>(value); };
  const std::vector<double> radii = {-1.0, 0.0, 64.0, kMaxInt};
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
       {0.0, -1.0, 9.0, kMaxInt},
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
      ExtractionOptions options{.method = one.method};
      one.set(options, value);
      CHECK(refusal_of_options(options).starts_with(one.name + ":"));
      CHECK_THAT(message_of<std::invalid_argument>([&] {
                   (void)extract_texture<float>(noise_image({4, 4}), options);
                 }),
                 holds_text(one.name + ":"));
    }
  }
  TvGaborOptions none{.components = {}};
  CHECK(refusal_of_tv_gabor(none).starts_with("components:"));
}

TEST_CASE("the ends of every range are accepted") {
  ExtractionOptions options{.method = Method::fixed, .radius = 1, .order = 0.0};
  CHECK(refusal_of_options(options).empty());
  options.order = std::nextafter(1.0, 0.0);
  options.radius = ExtractionOptions::kMaxRadius;
  CHECK(refusal_of_options(options).empty());
  TvGaborOptions tv_gabor{
      .lambda = TvGaborOptions::kMinLambda, .components = {{0.5, -720.0}}, .max_steps = 1};
  CHECK(refusal_of_tv_gabor(tv_gabor).empty());
  tv_gabor.lambda = TvGaborOptions::kMaxLambda;
  CHECK(refusal_of_tv_gabor(tv_gabor).empty());
}

TEST_CASE("parameters of other methods are ignored") {
  ExtractionOptions options{.order = kNan};
  options.tv_gabor.lambda = kNan;
  CHECK(refusal_of_options(options).empty());
  options = {};
  options.method = Method::tv_gabor;
  options.radius = 0;
  CHECK(refusal_of_options(options).empty());
}

// The norms, gradients, combinations and levels of the adaptive and the fixed method.

ExtractionOptions fixed_with(Norm norm, double order, int radius = 2) {
  return {.method = Method::fixed, .radius = radius, .order = order, .norm = norm};
}

ExtractionOptions adaptive_with(int levels, Gradient gradient, Combine combine) {
  return {.gradient = gradient, .combine = combine, .levels = levels};
}

void check_csgv(const GreyImage& image, int levels, Gradient gradient, Combine combine) {
  const RequestedPlanes wanted{.csgv = true, .order = true};
  const auto result =
      extract_texture<double>(image, adaptive_with(levels, gradient, combine), wanted);
  const Plane<double> expected =
      reference::csgv(image, levels, std::string(name_in(kGradientNames, gradient)),
                      std::string(name_in(kCombineNames, combine)));
  CHECK(largest_relative_difference(result.csgv, expected) < 1e-10);  // ll grows by 2 a level
  CHECK(largest_difference(result.order, reference::order_map(result.csgv)) < 1e-12);
  CHECK(largest_difference(result.texture, reference::texture(image, result.order, 2)) < 1e-10);
}

TEST_CASE("every gradient and combination agrees with its definition at every level") {
  for (const Size size : {Size{1, 1}, Size{2, 3}, Size{9, 12}, Size{33, 47}}) {
    for (const int levels : {1, 2, 3, ExtractionOptions::kMaxLevels}) {
      for (const Gradient gradient : {Gradient::sobel, Gradient::prewitt, Gradient::central}) {
        for (const Combine combine : {Combine::sum, Combine::l2, Combine::max}) {
          INFO(size.height << " x " << size.width << ", levels " << levels << ", "
                           << name_in(kGradientNames, gradient) << ", "
                           << name_in(kCombineNames, combine));
          check_csgv(cloth_image(size), levels, gradient, combine);
        }
      }
    }
  }
}

TEST_CASE("every norm agrees with its definition at fixed orders") {
  const GreyImage image = cloth_image({23, 30});
  for (const auto& [norm, name] : {std::pair{Norm::additive, "additive"},
                                   std::pair{Norm::sum, "sum"}, std::pair{Norm::none, "none"}}) {
    for (const double order : {0.0, 1e-300, 0.05, 0.5, 0.999}) {
      for (const int radius : {1, 2, 7, 40}) {
        INFO(name << ", order " << order << ", radius " << radius);
        const Plane<double> orders(23, 30, order);
        const Plane<double> expected = reference::texture(image, orders, radius, name);
        const double gain = norm == Norm::sum ? 1.0 / gl_weight_sum(order, radius) : 1.0;
        const auto options = fixed_with(norm, order, radius);
        CHECK(largest_difference(extract_texture<double>(image, options).texture, expected) <
              1e-11 * std::max(gain, 1.0));
      }
    }
  }
}

TEST_CASE("every norm agrees with its definition at adaptive orders") {
  const GreyImage image = cloth_image({41, 30});
  for (const auto& [norm, name] : {std::pair{Norm::sum, "sum"}, std::pair{Norm::none, "none"}}) {
    ExtractionOptions options{.norm = norm};
    const auto result = extract_texture<double>(image, options, RequestedPlanes::all());
    CHECK(largest_difference(result.texture, reference::texture(image, result.order, 2, name)) <
          1e-8);
  }
}

TEST_CASE("float textures of other norms are the double ones rounded") {
  const GreyImage image = noise_image({40, 31});
  for (const Norm norm : {Norm::sum, Norm::none}) {
    for (const double order : {0.3, 0.999, std::nextafter(1.0, 0.0)}) {
      const auto options = fixed_with(norm, order);
      const auto exact = extract_texture<double>(image, options).texture;
      CHECK(extract_texture<float>(image, options).texture == converted<float>(exact));
    }
  }
}

}  // namespace
}  // namespace touchtrial

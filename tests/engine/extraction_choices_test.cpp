// The options of the adaptive and the fixed method: norm, gradient, combine, levels.
#include "engine/extraction_choices.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/gl_norm.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/adaptive_reference.hpp"
#include "engine/reference/options_reference.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace touchtrial {
namespace {

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

std::string text_of(std::string_view word) {
  return std::string(word);
}

void check_csgv(const GreyImage& image, int levels, engine::Gradient gradient,
                engine::Combine combine) {
  const engine::WantedPlanes wanted{.csgv = true, .order = true};
  const auto result =
      engine::extract_texture<double>(image, adaptive_with(levels, gradient, combine), wanted);
  const Plane<double> expected =
      reference::csgv(image, levels, text_of(engine::name_among(engine::kGradientNames, gradient)),
                      text_of(engine::name_among(engine::kCombineNames, combine)));
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
                           << engine::name_among(engine::kGradientNames, gradient) << ", "
                           << engine::name_among(engine::kCombineNames, combine));
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

TEST_CASE("a level count outside 1 to 8 is refused by name") {
  for (const int levels : {0, -1, 9, std::numeric_limits<int>::max()}) {
    const auto options = adaptive_with(levels, engine::Gradient::sobel, engine::Combine::sum);
    CHECK_THROWS_WITH(engine::check_options(options),
                      "levels: must be from 1 to 8, not " + std::to_string(levels));
  }
}

TEST_CASE("the words of the options are found and named") {
  CHECK(engine::choice_named<engine::Norm>(engine::kNormNames, "sum") == engine::Norm::sum);
  CHECK(engine::choice_named<engine::Mapping>(engine::kMappingNames, "stretch") ==
        engine::Mapping::stretch);
  CHECK(engine::choice_named<engine::Gradient>(engine::kGradientNames, "central") ==
        engine::Gradient::central);
  CHECK(engine::choice_named<engine::Combine>(engine::kCombineNames, "l2") == engine::Combine::l2);
  CHECK_FALSE(engine::choice_named<engine::Norm>(engine::kNormNames, "l2").has_value());
  CHECK(engine::name_among(engine::kGradientNames, engine::Gradient::prewitt) == "prewitt");
}

}  // namespace
}  // namespace touchtrial

#include "engine/gl_texture.hpp"

#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/plane_comparison.hpp"
#include "engine/reference/extraction_reference.hpp"
#include "engine/reference/gl_weights.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"

#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

constexpr double kDoubleTolerance = 1e-10;
/// The promised error of a float texture in grey levels, on any 8-bit image.
constexpr double kFloatTolerance = 4e-5;
constexpr int kMaxRadius = 9;

/// The texture of one order by the code that the product uses in this precision.
template <typename Real>
Plane<Real> texture_of(const GreyImage& image, int radius, double order) {
  engine::ExtractionOptions options{
      .method = engine::Method::fixed, .radius = radius, .order = order};
  return engine::extract_texture<Real>(image, options).texture;
}

void check_against_definition(const GreyImage& image, double order, int radius) {
  const Plane<double> orders(image.height(), image.width(), order);
  const Plane<double> expected = reference::texture(image, orders, radius);
  CHECK(largest_difference(engine::gl_texture<double>(image, radius, order), expected) <
        kDoubleTolerance);
  CHECK(largest_difference(texture_of<float>(image, radius, order), expected) < kFloatTolerance);
}

TEST_CASE("gl_texture of one bright pixel shows the weights of the mask") {
  GreyImage image(5, 5);
  image.at(2, 2) = 80;
  const Plane<double> texture = engine::gl_texture<double>(image, 2, 0.5);
  CHECK(texture.at(2, 2) == Approx(80 * (0.5 + 0.125)).epsilon(1e-15));
  CHECK(texture.at(2, 3) == Approx(-80 * 0.5 / 8).epsilon(1e-15));
  CHECK(texture.at(0, 4) == Approx(-80 * 0.125 / 8).epsilon(1e-15));
  CHECK(texture.at(0, 1) == 0.0);  // a knight's move away: in no ring
}

TEST_CASE("gl_texture of a bright pixel reaches the bound of 255 (1 - S_K)") {
  GreyImage dot(17, 17);
  dot.at(8, 8) = 255;
  for (int radius = 1; radius <= kMaxRadius; ++radius) {
    for (const double order : {0.1, 0.5, 0.9, 0.999}) {
      const double bound = 255.0 * (1.0 - engine::gl_weight_sum(order, radius));
      INFO("order " << order << ", radius " << radius);
      CHECK(engine::gl_texture<double>(dot, radius, order).at(8, 8) ==
            Approx(bound).epsilon(1e-13));
    }
  }
}

TEST_CASE("gl_texture agrees with its definition at every size and radius") {
  for (const Size size : awkward_sizes()) {
    for (const auto& [name, image] : example_images(size)) {
      for (int radius = 1; radius <= kMaxRadius; ++radius) {
        INFO(name << ", " << size.height << " x " << size.width << ", radius " << radius);
        check_against_definition(image, 0.55, radius);
      }
    }
  }
}

TEST_CASE("gl_texture takes the order of the square that contains the pixel") {
  const GreyImage image = noise_image({7, 9});
  Plane<double> half(4, 5);
  Plane<double> full(7, 9);
  for (int y = 0; y < 7; ++y) {
    for (int x = 0; x < 9; ++x) {
      full.at(y, x) = half.at(y / 2, x / 2) = 0.05 * (y / 2) + 0.1 * (x / 2);
    }
  }
  CHECK(largest_difference(engine::gl_texture<double>(image, 3, half),
                           reference::texture(image, full, 3)) < kDoubleTolerance);
}

TEST_CASE("the reference's weights are the binomial coefficients of the order") {
  const double v = 0.6;
  const std::vector<double> weights = reference::gl_weights(v, 3);
  REQUIRE(weights.size() == 4);
  CHECK(weights[0] == 1.0);
  CHECK(weights[1] == Approx(-v).epsilon(1e-15));
  CHECK(weights[2] == Approx(v * (v - 1) / 2).epsilon(1e-15));
  CHECK(weights[3] == Approx(-v * (v - 1) * (v - 2) / 6).epsilon(1e-15));
}

TEST_CASE("gl_weight_sum is the sum of the weights, above 0 and at most 1") {
  for (const double order : {0.0, 0.1, 0.5, 0.666, 0.9, 0.999999}) {
    for (int radius = 1; radius <= 7; ++radius) {
      const std::vector<double> weights = reference::gl_weights(order, radius);
      const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
      INFO("order " << order << ", radius " << radius);
      CHECK(engine::gl_weight_sum(order, radius) == Approx(sum).margin(1e-15));
      CHECK(engine::gl_weight_sum(order, radius) > 0.0);
      CHECK(engine::gl_weight_sum(order, radius) <= 1.0);
    }
  }
}

TEST_CASE("gl_weight_sum names the option that it refuses") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double order : {kNan, kInfinity, -kInfinity, 1.0, -1.0, -1e-9}) {
    INFO("order " << order);
    CHECK(message_of<std::invalid_argument>([&] {
            (void)engine::gl_weight_sum(order, 2);
          }).starts_with("order:"));
  }
  CHECK(message_of<std::invalid_argument>([] {
          (void)engine::gl_weight_sum(0.5, 0);
        }).starts_with("radius:"));
  CHECK_THROWS_AS(engine::gl_weight_sum(0.5, -1), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

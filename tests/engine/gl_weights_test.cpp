#include "engine/gl_weights.hpp"

#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

TEST_CASE("gl_weights are the binomial coefficients of the order") {
  const double v = 0.6;
  const std::vector<double> weights = engine::gl_weights(v, 3);
  REQUIRE(weights.size() == 4);
  CHECK(weights[0] == 1.0);
  CHECK(weights[1] == Approx(-v).epsilon(1e-15));
  CHECK(weights[2] == Approx(v * (v - 1) / 2).epsilon(1e-15));
  CHECK(weights[3] == Approx(-v * (v - 1) * (v - 2) / 6).epsilon(1e-15));
}

TEST_CASE("gl_weights of order zero keep the sample and nothing else") {
  for (std::size_t k = 1; k <= 7; ++k) CHECK(engine::gl_weights(0.0, 7)[k] == 0.0);
}

TEST_CASE("gl_weights sum to gl_weight_sum, which leaves a positive share") {
  for (const double order : {0.0, 0.1, 0.5, 0.666, 0.9, 0.999999}) {
    for (int radius = 1; radius <= 7; ++radius) {
      const std::vector<double> weights = engine::gl_weights(order, radius);
      const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
      INFO("order " << order << ", radius " << radius);
      CHECK(engine::gl_weight_sum(order, radius) == Approx(sum).margin(1e-15));
      CHECK(engine::gl_weight_sum(order, radius) > 0.0);
      CHECK(engine::gl_weight_sum(order, radius) <= 1.0);
    }
  }
}

TEST_CASE("gl_weights name the option that they refuse") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double order : {kNan, kInfinity, -kInfinity, 1.0, -1.0, -1e-9}) {
    INFO("order " << order);
    CHECK(refusal_of([&] { (void)engine::gl_weights(order, 2); }).starts_with("order:"));
    CHECK_THROWS_AS(engine::gl_weight_sum(order, 2), std::invalid_argument);
  }
  CHECK(refusal_of([] { (void)engine::gl_weights(0.5, 0); }).starts_with("radius:"));
  CHECK_THROWS_AS(engine::gl_weight_sum(0.5, -1), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

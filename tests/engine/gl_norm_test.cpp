#include "engine/gl_norm.hpp"

#include "engine/reference/gl_weights.hpp"
#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

TEST_CASE("the reference's weights are the binomial coefficients of the order") {
  const double v = 0.6;
  const std::vector<double> weights = reference::gl_weights(v, 3);
  REQUIRE(weights.size() == 4);
  CHECK(weights[0] == 1.0);
  CHECK(weights[1] == Approx(-v).epsilon(1e-15));
  CHECK(weights[2] == Approx(v * (v - 1) / 2).epsilon(1e-15));
  CHECK(weights[3] == Approx(-v * (v - 1) * (v - 2) / 6).epsilon(1e-15));
}

TEST_CASE("the reference's weights of order zero keep the sample and nothing else") {
  for (std::size_t k = 1; k <= 7; ++k) CHECK(reference::gl_weights(0.0, 7)[k] == 0.0);
}

TEST_CASE("gl_weight_sum is what the weights sum to, a positive share") {
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
    CHECK(refusal_of([&] { (void)engine::gl_weight_sum(order, 2); }).starts_with("order:"));
  }
  CHECK(refusal_of([] { (void)engine::gl_weight_sum(0.5, 0); }).starts_with("radius:"));
  CHECK_THROWS_AS(engine::gl_weight_sum(0.5, -1), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

#include "engine/gaussian_filter.hpp"

#include "engine/example_images.hpp"
#include "engine/reference/mirror.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

/// The definition: a two-dimensional sum over all weights that matter.
double filtered_slowly(const Plane<double>& plane, double sigma_px, int y, int x) {
  const int radius = static_cast<int>(std::ceil(9.0 * sigma_px));
  double sum = 0.0;
  double weights = 0.0;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const double weight = std::exp(-(dx * dx + dy * dy) / (2.0 * sigma_px * sigma_px));
      sum += weight * reference::mirrored_sample(plane, y + dy, x + dx);
      weights += weight;
    }
  }
  return sum / weights;
}

TEST_CASE("gaussian_filtered agrees with the direct two-dimensional sum on any size") {
  const auto size = GENERATE(Size{1, 1}, Size{1, 7}, Size{7, 1}, Size{2, 2}, Size{3, 3}, Size{5, 7},
                             Size{13, 20});
  const double sigma_px = GENERATE(0.05, 0.3, 1.0, 2.0, 3.7);
  const Plane<double> plane = random_texture(size.height, size.width, 1, 255.0);
  const Plane<double> filtered = engine::gaussian_filtered(plane, sigma_px);
  double worst = 0.0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double slow = filtered_slowly(plane, sigma_px, y, x);
      worst = std::max(worst, std::abs(filtered.at(y, x) - slow));
    }
  }
  CAPTURE(size.height, size.width, sigma_px);
  CHECK(worst < 1e-9);
}

TEST_CASE("gaussian_filtered gives the weights of a sampled Gaussian") {
  Plane<double> impulse(1, 61, 0.0);
  impulse.at(0, 30) = 1.0;
  const Plane<double> response = engine::gaussian_filtered(impulse, 2.0);
  CHECK(response.at(0, 30) == Approx(0.19947114020071635).epsilon(1e-12));
  CHECK(response.at(0, 32) / response.at(0, 30) == Approx(std::exp(-0.5)).epsilon(1e-12));
  CHECK(response.at(0, 23) == response.at(0, 37));
  CHECK(response.at(0, 30 - 14) / response.at(0, 30) == Approx(std::exp(-24.5)).epsilon(1e-9));
  CHECK(response.at(0, 30 - 15) == 0.0);
}

TEST_CASE("gaussian_filtered keeps a flat plane exactly flat") {
  const double sigma_px = GENERATE(0.4, 2.0, 50.0, 1e6);
  const Plane<double> flat(6, 9, 0.1);
  CHECK(engine::gaussian_filtered(flat, sigma_px) == flat);
}

TEST_CASE("gaussian_filtered with sigma 0 gives the plane itself") {
  const Plane<double> plane = random_texture(4, 5, 4);
  CHECK(engine::gaussian_filtered(plane, 0.0) == plane);
}

TEST_CASE("gaussian_filtered with a huge or infinite sigma gives the mean everywhere") {
  const double sigma_px = GENERATE(1e3, 1e300, std::numeric_limits<double>::infinity());
  const Plane<double> plane = random_texture(7, 10, 5);
  const double mean = mean_of(plane);
  const Plane<double> filtered = engine::gaussian_filtered(plane, sigma_px);
  for (const double value : filtered.samples()) {
    REQUIRE(value == Approx(mean).margin(1e-9));
  }
}

TEST_CASE("gaussian_filtered refuses an empty plane and an impossible sigma") {
  const Plane<double> plane(2, 2, 1.0);
  CHECK_THROWS_AS(engine::gaussian_filtered(Plane<double>(), 1.0), std::invalid_argument);
  CHECK_THROWS_AS(engine::gaussian_filtered(plane, -0.1), std::invalid_argument);
  CHECK_THROWS_AS(engine::gaussian_filtered(plane, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

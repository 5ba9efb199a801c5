#include "engine/fourier/plane_filter.hpp"

#include "core/random.hpp"
#include "engine/every_simd_target.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

template <typename Real>
Plane<Real> noise(int height, int width) {
  RandomStream random(4, "plane filter test");
  Plane<Real> plane(height, width);
  for (Real& sample : plane.samples()) sample = static_cast<Real>(random.uniform(-1.0, 1.0));
  return plane;
}

/// Filters a plane by rows and columns.
template <typename Real>
Plane<Real> filtered(const Plane<Real>& plane, const Plane<double>& spectrum, Real scale) {
  engine::PlaneFilter<Real> filter(plane.height(), plane.width());
  typename engine::PlaneFilter<Real>::Workspace workspace(plane.width());
  for (int y = 0; y < plane.height(); y += 2) {
    filter.write_rows(y, plane.row(y).data(), plane.row(y + 1).data(), workspace);
  }
  const auto factors = engine::arranged_factors<Real>(spectrum, plane.width());
  for (std::size_t block = 0; block < filter.blocks().count(); ++block) {
    filter.filter_columns(block, factors);
  }
  Plane<Real> result(plane.height(), plane.width());
  for (int y = 0; y < plane.height(); y += 2) {
    filter.read_rows(y, scale, result.row(y).data(), result.row(y + 1).data(), workspace);
  }
  return result;
}

/// Factors that are the same for opposite frequencies.
Plane<double> smoothing_spectrum(int height, int width) {
  Plane<double> spectrum(height, width / 2 + 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x <= width / 2; ++x) {
      const double turns = static_cast<double>(2 * y) / height + static_cast<double>(x) / width;
      spectrum.at(y, x) = 0.5 + 0.25 * std::cos(2.0 * std::numbers::pi * turns);
    }
  }
  return spectrum;
}

TEMPLATE_TEST_CASE("a plane that is filtered by its factors is their convolution on every target",
                   "", float, double) {
  on_every_simd_target([] {
    for (const auto& [height, width] : {std::pair{16, 16}, std::pair{18, 36}, std::pair{40, 50}}) {
      const Plane<TestType> plane = noise<TestType>(height, width);
      const Plane<TestType> result =
          filtered<TestType>(plane, smoothing_spectrum(height, width), TestType{3});
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const double left = plane.at((y + height - 2) % height, (x + width - 1) % width);
          const double right = plane.at((y + 2) % height, (x + 1) % width);
          const double expected = 3.0 * (0.5 * plane.at(y, x) + 0.125 * (left + right));
          REQUIRE(result.at(y, x) == Approx(expected).margin(sizeof(TestType) == 4 ? 2e-6 : 1e-14));
        }
      }
    }
  });
}

TEST_CASE("rows that are not filtered are read as they were written, each time") {
  const Plane<double> plane = noise<double>(16, 20);
  engine::PlaneFilter<double> filter(16, 20);
  engine::PlaneFilter<double>::Workspace workspace(20);
  std::vector<double> upper(20), lower(20), again(20);
  filter.write_rows(6, plane.row(6).data(), plane.row(7).data(), workspace);
  // Columns are not transformed here, so their part of the gain is missing.
  filter.read_rows(6, 16.0, upper.data(), lower.data(), workspace);
  filter.read_rows(6, 16.0, again.data(), lower.data(), workspace);
  CHECK(upper == again);
  for (std::size_t x = 0; x < 20; ++x) {
    CHECK(upper[x] == Approx(plane.row(6)[x]).margin(1e-14));
    CHECK(lower[x] == Approx(plane.row(7)[x]).margin(1e-14));
  }
}

TEST_CASE("a plane with an odd or short side is not filtered") {
  CHECK_THROWS_AS(engine::PlaneFilter<float>(15, 16), std::invalid_argument);
  CHECK_THROWS_AS(engine::PlaneFilter<float>(16, 21), std::invalid_argument);
  CHECK_THROWS_AS(engine::PlaneFilter<double>(14, 16), std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

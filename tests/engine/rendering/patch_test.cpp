#include "engine/rendering/patch.hpp"

#include "core/random.hpp"
#include "engine/every_simd_target.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace touchtrial {
namespace {

/// Four rows of four heights, the last ones of their plane.
using Heights = std::array<float, 16>;

struct Point {
  double u;
  double v;
};

std::vector<Heights> hard_heights() {
  constexpr float kLargest = std::numeric_limits<float>::max();
  constexpr float kSmallest = std::numeric_limits<float>::denorm_min();
  std::vector<Heights> all(4);
  all[0].fill(-37.25F);
  for (std::size_t i = 0; i < 16; ++i) {
    all[1][i] = i % 2 == 0 ? kLargest : -kLargest;
    all[2][i] = i % 3 == 0 ? kSmallest : 128.0F;
  }
  all[3][5] = 255.0F;
  RandomStream random(1, "patches");
  for (int n = 0; n < 200; ++n) {
    Heights heights;
    for (float& height : heights) height = static_cast<float>(random.uniform(-128.0, 127.0));
    all.push_back(heights);
  }
  return all;
}

std::vector<Point> hard_points() {
  const double below_one = std::nextafter(1.0, 0.0);
  std::vector<Point> points = {
      {0.0, 0.0}, {1.0, 1.0}, {0.5, 0.0}, {0.0, below_one}, {1e-300, 0.25}};
  RandomStream random(2, "points");
  for (int n = 0; n < 20; ++n) points.push_back({random.uniform(), random.uniform()});
  return points;
}

/// All sums, as one list.
std::vector<double> sums_by(engine::SumOfPatch sum) {
  std::vector<double> found;
  for (const Heights& heights : hard_heights()) {
    for (const Point& at : hard_points()) {
      const engine::PatchSums sums = sum(heights.data(), 4, at.u, at.v);
      found.insert(found.end(), {sums.value, sums.along_x, sums.along_y});
    }
  }
  return found;
}

/// The tangential force at one of the four middle pixels, from its eight neighbours: each pulls by
/// its difference over the squared distance, along the line between them.
Vec2 force_at(const Heights& heights, int y, int x) {
  Vec2 force;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const double difference = double{heights[4 * y + x]} - heights[4 * (y + dy) + x + dx];
      force = force + (difference / (dx * dx + dy * dy)) * Vec2{1.0 * dx, 1.0 * dy};
    }
  }
  return force;
}

double between(const std::array<double, 4>& corners, const Point& at) {
  const double above = (1.0 - at.u) * corners[0] + at.u * corners[1];
  const double below = (1.0 - at.u) * corners[2] + at.u * corners[3];
  return (1.0 - at.v) * above + at.v * below;
}

TEST_CASE("every instruction set gives the same digits of a patch") {
  std::vector<double> bilinear;
  std::vector<double> spline;
  on_every_simd_target([&] {
    const std::vector<double> by_bilinear = sums_by(engine::bilinear_sum());
    const std::vector<double> by_spline = sums_by(engine::spline_sum());
    if (bilinear.empty()) {
      bilinear = by_bilinear;
      spline = by_spline;
    }
    CHECK(by_bilinear == bilinear);
    CHECK(by_spline == spline);
  });
  CHECK(std::ranges::all_of(bilinear, [](double sum) { return std::isfinite(sum); }));
  CHECK(std::ranges::all_of(spline, [](double sum) { return std::isfinite(sum); }));
}

TEST_CASE("the bilinear sums of a patch are height and force between its four middle pixels") {
  const engine::SumOfPatch sum = engine::bilinear_sum();
  for (const Heights& heights : hard_heights()) {
    const double largest = std::abs(
        *std::ranges::max_element(heights, {}, [](float height) { return std::abs(height); }));
    for (const Point& at : hard_points()) {
      std::array<double, 4> height;
      std::array<double, 4> force_x;
      std::array<double, 4> force_y;
      for (int i = 0; i < 4; ++i) {
        const int y = 1 + i / 2;
        const int x = 1 + i % 2;
        height[i] = heights[4 * y + x];
        force_x[i] = force_at(heights, y, x).x;
        force_y[i] = force_at(heights, y, x).y;
      }
      const engine::PatchSums sums = sum(heights.data(), 4, at.u, at.v);
      CAPTURE(at.u, at.v);
      REQUIRE(sums.value == Approx(between(height, at)).margin(1e-14 * largest));
      REQUIRE(sums.along_x == Approx(between(force_x, at)).margin(1e-14 * largest));
      REQUIRE(sums.along_y == Approx(between(force_y, at)).margin(1e-14 * largest));
    }
  }
}

TEST_CASE("only points within the outer pixels have a patch") {
  const int height = GENERATE(1, 3, 4, 9);
  const int width = GENERATE(1, 2, 4, 7);
  const std::vector<float> heights(static_cast<std::size_t>(height * width), 1.0F);
  const engine::Patches patches(heights, height, width, engine::bilinear_sum());
  for (double y = -1.0; y <= height; y += 0.25) {
    for (double x = -1.0; x <= width; x += 0.25) {
      const bool fits = std::floor(x) >= 1 && std::floor(y) >= 1 && std::floor(x) + 2 < width &&
                        std::floor(y) + 2 < height;
      REQUIRE(patches.has({x, y}) == fits);
      if (fits) REQUIRE(patches.at({x, y}).value == 1.0);
    }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(patches.has({nan, 1.0}));
  CHECK_FALSE(engine::Patches().has({1.0, 1.0}));
}

}  // namespace
}  // namespace touchtrial

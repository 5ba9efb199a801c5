#include "device/drivers/simulated/simulated_hand.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <vector>

namespace touchtrial {
namespace {

constexpr PlaneGeometry kPlane{0.2, 500, 500};
constexpr PlaneGeometry kOblong{0.2, 120, 300};
constexpr double kTickS = 0.001;

std::vector<device::PathPoint> points_of(const PlaneGeometry& plane,
                                         const device::ExplorationOptions& options,
                                         std::uint64_t seed) {
  RandomStream random(seed, "exploration_path_test");
  const device::ExplorationPath path(plane, options, random);
  std::vector<device::PathPoint> points;
  std::size_t stroke = 0;
  const int ticks = static_cast<int>(options.duration_s / kTickS);
  for (int i = 0; i < ticks; ++i) points.push_back(path.at(i * kTickS, stroke));
  return points;
}

TEST_CASE("an exploration path stays within its margin") {
  const PlaneGeometry plane =
      GENERATE(as<PlaneGeometry>{}, kPlane, kOblong, PlaneGeometry{0.2, 1, 7});
  const device::ExplorationOptions options;
  const double x_mm = std::min(options.margin_mm, plane.width_mm() / 5.0);
  const double y_mm = std::min(options.margin_mm, plane.height_mm() / 5.0);
  constexpr double kRounding = 1e-9;
  for (const device::PathPoint& point : points_of(plane, options, 3)) {
    REQUIRE(point.position_mm.x >= x_mm - kRounding);
    REQUIRE(point.position_mm.x <= plane.width_mm() - x_mm + kRounding);
    REQUIRE(point.position_mm.y >= y_mm - kRounding);
    REQUIRE(point.position_mm.y <= plane.height_mm() - y_mm + kRounding);
  }
}

TEST_CASE("strokes have a speed of 50 to 150 mm/s, for most of their time") {
  const PlaneGeometry plane = GENERATE(as<PlaneGeometry>{}, kPlane, kOblong);
  const std::vector<device::PathPoint> points = points_of(plane, {}, GENERATE(1U, 2U, 3U));
  int at_speed = 0;
  for (const device::PathPoint& point : points) {
    const double speed_mm_s = norm(point.velocity_mm_s);
    REQUIRE(speed_mm_s <= 150.0);
    at_speed += speed_mm_s >= 50.0 ? 1 : 0;
  }
  CHECK(at_speed > static_cast<int>(points.size()) * 6 / 10);
}

TEST_CASE("the speeds of strokes fill the range of the options") {
  const std::vector<device::PathPoint> points =
      points_of(kPlane, {.slowest_mm_s = 80.0, .fastest_mm_s = 120.0, .duration_s = 60.0}, 5);
  double fastest_mm_s = 0.0;
  for (const device::PathPoint& p : points)
    fastest_mm_s = std::max(fastest_mm_s, norm(p.velocity_mm_s));
  CHECK(fastest_mm_s > 115.0);
  CHECK(fastest_mm_s <= 120.0);
}

TEST_CASE("position and velocity of a path agree with each other and never jump") {
  const std::vector<device::PathPoint> points = points_of(kPlane, {}, 11);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 step_mm = points[i].position_mm - points[i - 1].position_mm;
    const Vec2 mean_mm_s = 0.5 * (points[i].velocity_mm_s + points[i - 1].velocity_mm_s);
    // The trapezium rule's error is h^3 / 12 times the largest jerk, 6 * 150 / ramp^2.
    REQUIRE(norm(step_mm - kTickS * mean_mm_s) < 3e-5);
    // The steepest change of speed is 1.5 * 150 mm/s a ramp.
    REQUIRE(norm(points[i].velocity_mm_s - points[i - 1].velocity_mm_s) < 2.9);
  }
}

TEST_CASE("a path is a function of its seed, and other seeds give other paths") {
  const auto first = points_of(kPlane, {}, 21);
  const auto again = points_of(kPlane, {}, 21);
  const auto other = points_of(kPlane, {}, 22);
  CHECK(first.front().position_mm == again.front().position_mm);
  CHECK(first.back().position_mm == again.back().position_mm);
  CHECK(norm(first.front().position_mm - other.front().position_mm) > 0.1);
  CHECK(norm(first[5000].position_mm - other[5000].position_mm) > 0.1);
}

TEST_CASE("a path rests at its end") {
  RandomStream random(1, "exploration_path_test");
  const device::ExplorationPath path(kPlane, {.duration_s = 1.0}, random);
  std::size_t stroke = 0;
  const device::PathPoint late = path.at(100.0, stroke);
  CHECK(norm(late.velocity_mm_s) == 0.0);
  CHECK(late.position_mm == path.at(200.0, stroke).position_mm);
}

TEST_CASE("a path refuses a plane without area and options out of range") {
  RandomStream random(1, "exploration_path_test");
  CHECK_THROWS_AS(device::ExplorationPath({0.2, 0, 5}, {}, random), std::invalid_argument);
  CHECK_THROWS_AS(device::ExplorationPath(kPlane, {.slowest_mm_s = 0.0}, random),
                  std::invalid_argument);
  CHECK_THROWS_AS(device::ExplorationPath(kPlane, {.fastest_mm_s = 10.0}, random),
                  std::invalid_argument);
  CHECK_THROWS_AS(device::ExplorationPath(kPlane, {.margin_mm = -1.0}, random),
                  std::invalid_argument);
  CHECK_THROWS_AS(device::ExplorationPath(kPlane, {.duration_s = 0.0}, random),
                  std::invalid_argument);
}

}  // namespace
}  // namespace touchtrial

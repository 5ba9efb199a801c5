/// \file The law that distinguishes the rendering models: a hand that goes round a closed path
/// under `surface` returns with the energy that it had.
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace touchtrial {
namespace {

double side_work_mj(const engine::RenderingModel& model, engine::Bristle& touch, Vec3 from_mm,
                    Vec3 to_mm, double step_mm) {
  const Vec3 way_mm = to_mm - from_mm;
  const double steps = std::max(1.0, std::ceil(norm(way_mm) / step_mm));
  const auto along_n = [&](double share) {
    return dot(model.force_n(from_mm + share * way_mm, {}, touch), way_mm);
  };
  double sum = along_n(0.0);
  for (double i = 0.0; i < steps; ++i) {
    sum += 4.0 * along_n((i + 0.5) / steps);
    sum += (i + 1.0 < steps ? 2.0 : 1.0) * along_n((i + 1.0) / steps);
  }
  return sum / (6.0 * steps);
}

/// A circle at a constant height, as a polygon.
std::vector<Vec3> circle_path(Vec3 centre_mm, double radius_mm) {
  constexpr int kCorners = 360;
  std::vector<Vec3> path;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    path.push_back(centre_mm + radius_mm * Vec3{std::cos(angle), std::sin(angle), 0.0});
  }
  return path;
}

/// Presses down at one point, slides straight to another at that depth, lifts, and returns in the
/// air.
std::vector<Vec3> press_slide_lift_path(Vec2 from_mm, Vec2 to_mm, double top_mm, double bottom_mm) {
  return {{from_mm.x, from_mm.y, top_mm},
          {from_mm.x, from_mm.y, bottom_mm},
          {to_mm.x, to_mm.y, bottom_mm},
          {to_mm.x, to_mm.y, top_mm}};
}

/// Work of the model's force along the closed path through these corners and back to the first, in
/// mJ (N mm); above 0, the hand gains energy. At velocity zero, from the start of a presentation.
/// Simpson's rule: the error shrinks with the fourth power of step_mm where the force is smooth,
/// and with the second at a landing, where the force has a kink: some 1e-6 mJ by default.
double loop_work_mj(const engine::RenderingModel& model, std::span<const Vec3> corners_mm,
                    double step_mm = 0.005) {
  engine::Bristle touch;
  double work_mj = 0.0;
  for (std::size_t i = 0; i < corners_mm.size(); ++i) {
    const Vec3 next_mm = corners_mm[(i + 1) % corners_mm.size()];
    work_mj += side_work_mj(model, touch, corners_mm[i], next_mm, step_mm);
  }
  return work_mj;
}

/// One of the textures on which the law must hold.
Plane<double> hostile_texture(int which) {
  if (which == 0) return random_texture(40, 50, 1, 127.0);
  Plane<double> texture(40, 50);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) {
      if (which == 1) texture.at(y, x) = x < 25 ? -127.0 : 127.0;
      if (which == 2) texture.at(y, x) = x == 25 && y == 20 ? 127.0 : 0.0;
      if (which == 3) texture.at(y, x) = (x + y) % 2 == 0 ? -127.0 : 127.0;
    }
  }
  return texture;
}

engine::RenderingModel model_at_budget(engine::FieldView field,
                                       const engine::RenderingOptions& options) {
  return {field, options, engine::choose_gains({&field, 1}, options).per_field[0]};
}

/// A closed path of random corners on, beside and above the plane, down to the stated load's depth.
std::vector<Vec3> random_loop(std::uint64_t seed) {
  RandomStream random(seed, "loop");
  std::vector<Vec3> corners;
  for (int i = 0; i < 5; ++i) {
    corners.push_back(
        {random.uniform(-3.0, 13.0), random.uniform(-3.0, 11.0), random.uniform(-2.5, 1.0)});
  }
  return corners;
}

double largest_loop_mj(const engine::RenderingModel& model) {
  double largest_mj = 0.0;
  for (std::uint64_t seed = 0; seed < 15; ++seed) {
    largest_mj = std::max(largest_mj, std::abs(loop_work_mj(model, random_loop(seed))));
    RandomStream random(seed, "planar and pressing loops");
    const Vec3 centre_mm{random.uniform(0.0, 10.0), random.uniform(0.0, 8.0), -1.75};
    const double radius_mm = random.uniform(0.1, 4.0);
    const Vec2 from_mm{centre_mm.x, centre_mm.y};
    const Vec2 to_mm{random.uniform(0.0, 10.0), random.uniform(0.0, 8.0)};
    for (const auto& loop :
         {circle_path(centre_mm, radius_mm), press_slide_lift_path(from_mm, to_mm, 2.0, -1.75)}) {
      largest_mj = std::max(largest_mj, std::abs(loop_work_mj(model, loop)));
    }
  }
  return largest_mj;
}

TEST_CASE("surface does no work round closed loops, also across the plane's edge") {
  engine::RenderingOptions options = surface_options();
  options.filter_mm = GENERATE(0.0, 0.4);
  const engine::TextureField field =
      engine::make_texture_field(hostile_texture(GENERATE(0, 1, 2, 3)), options);
  CHECK(largest_loop_mj(model_at_budget(field.view(), options)) < 1e-6);
}

TEST_CASE("the rest of surface's work comes from the quadrature, and shrinks with the step") {
  const engine::TextureField field = random_surface(40, 50, 2, 80.0);
  const engine::RenderingModel model = model_at_budget(field.view(), surface_options());
  const std::vector<Vec3> loop = circle_path({5.0, 4.0, -1.75}, 3.0);
  CHECK(std::abs(loop_work_mj(model, loop, 0.001)) < 1e-11);
}

TEST_CASE("paper does work round the same loops, which is why there is a second model") {
  const engine::TextureField field = random_field(40, 50, 1, 127.0);
  const double largest_mj = largest_loop_mj(model_at_budget(field.view(), {}));
  CHECK(largest_mj > 1e-3);
  CHECK(largest_mj < 1.0);
}

TEST_CASE("loop_work of a wall is zero, and of a ramp the difference between border and inside") {
  std::vector<float> heights(50 * 50);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(i / 50);
  const engine::FieldView ramp = view_of_heights(heights, 50, 50);
  engine::RenderingOptions options{.max_force_n = 1e6};
  const engine::RenderingModel model(ramp, options, {0.01, 0.0});
  // F_y is -4 grey levels per pixel inside, and -3 in the first column, where two of the six
  // neighbours above and below are missing.
  const std::vector<Vec3> square = {
      {0.05, 3.0, -1.0}, {6.0, 3.0, -1.0}, {6.0, 8.0, -1.0}, {0.05, 8.0, -1.0}};
  CHECK(loop_work_mj(model, square) == Approx(0.01 * (-4.0 + 3.0) * 5.0).epsilon(1e-9));
  const std::vector<Vec3> back(square.rbegin(), square.rend());
  CHECK(loop_work_mj(model, back) == Approx(-0.01 * (-4.0 + 3.0) * 5.0).epsilon(1e-9));
  const engine::RenderingModel wall(ramp, options, {});
  CHECK(loop_work_mj(wall, random_loop(3)) == Approx(0.0).margin(1e-7));
}

TEST_CASE("with friction a hand loses energy round every loop, and never gains") {
  engine::RenderingOptions options = surface_options();
  options.friction = GENERATE(0.01, 0.3);
  const engine::TextureField field = random_surface(40, 50, 3, 80.0);
  const engine::RenderingModel model = model_at_budget(field.view(), options);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CHECK(loop_work_mj(model, random_loop(seed)) < 1e-6);
  }
  // Kinetic friction over a long circle: about mu * load * length.
  const double lost_mj = -loop_work_mj(model, circle_path({5.0, 4.0, -1.75}, 3.0));
  CHECK(lost_mj == Approx(options.friction * 0.7 * 6.0 * 3.14159).epsilon(0.15));
}

}  // namespace
}  // namespace touchtrial

#include "engine/rendering/surface_model.hpp"

#include "core/random.hpp"
#include "engine/rendering/cubic_spline.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace touchtrial {
namespace {

constexpr engine::Gains kGains{.height_mm = 0.004};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 1 on the plane, 0 beyond the rim, and a polynomial of degree five in between.
double fade(double place_mm, double side_mm) {
  const double beyond_mm = std::max({0.0, -place_mm, place_mm - side_mm});
  const double s = std::min(1.0, beyond_mm / engine::kRimMm);
  return 1.0 - 10.0 * std::pow(s, 3) + 15.0 * std::pow(s, 4) - 6.0 * std::pow(s, 5);
}

/// The slow reference, by definition: the potential U = k/2 * max(0, e)^2 with
/// e = depth + alpha * h, in mJ (N mm), whose gradient the model gives. h fades to 0 over the rim
/// beyond the plane's edges.
/// \param alpha_mm  per grey level
double surface_potential_mj(engine::FieldView field, double stiffness_n_per_mm, double alpha_mm,
                            Vec3 position_mm) {
  const PlaneGeometry& plane = field.geometry;
  const Vec2 px = plane.to_px(position_mm.x, position_mm.y);
  const double h =
      engine::spline_at(field.heights, plane.height_px, plane.width_px, px.x, px.y).value *
      fade(position_mm.x, plane.width_mm()) * fade(position_mm.y, plane.height_mm());
  const double pressed_mm = std::max(0.0, alpha_mm * h - position_mm.z);
  return 0.5 * stiffness_n_per_mm * pressed_mm * pressed_mm;
}

/// Force on a hand at rest, from a presentation of its own.
Vec3 still_force_n(const engine::SurfaceModel& model, Vec3 position_mm) {
  engine::Bristle bristle;
  return model.force_n(position_mm, {}, bristle);
}

engine::RenderingOptions unlimited() {
  engine::RenderingOptions options = surface_options();
  options.max_force_n = 1e30;
  return options;
}

/// Points on, beside and above a plane of this size, as deep as 3 mm.
Vec3 random_point(RandomStream& random, const PlaneGeometry& plane) {
  return {random.uniform(-3.0, plane.width_mm() + 3.0),
          random.uniform(-3.0, plane.height_mm() + 3.0), random.uniform(-3.0, 0.2)};
}

TEST_CASE("SurfaceModel's force is minus the gradient of its potential, everywhere") {
  const int height = GENERATE(1, 3, 30);
  const int width = GENERATE(1, 40);
  const engine::TextureField field = random_surface(height, width, 1, 60.0);
  const engine::SurfaceModel model(field.view(), unlimited(), kGains);
  const auto potential_mj = [&](Vec3 at_mm) {
    return surface_potential_mj(field.view(), unlimited().stiffness_n_per_mm, kGains.height_mm,
                                at_mm);
  };
  RandomStream random(2, "points");
  constexpr double kStepMm = 1e-5;
  double strongest_n = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 at_mm = random_point(random, field.view().geometry);
    const auto slope_along = [&](Vec3 axis) {
      return (potential_mj(at_mm + kStepMm * axis) - potential_mj(at_mm - kStepMm * axis)) /
             (2.0 * kStepMm);
    };
    const Vec3 force_n = still_force_n(model, at_mm);
    CAPTURE(height, width, at_mm.x, at_mm.y, at_mm.z);
    REQUIRE(force_n.x == Approx(-slope_along({1.0, 0.0, 0.0})).margin(1e-6));
    REQUIRE(force_n.y == Approx(-slope_along({0.0, 1.0, 0.0})).margin(1e-6));
    REQUIRE(force_n.z == Approx(-slope_along({0.0, 0.0, 1.0})).margin(1e-6));
    strongest_n = std::max(strongest_n, std::hypot(force_n.x, force_n.y));
  }
  if (height * width > 1) CHECK(strongest_n > 0.01);
}

TEST_CASE("SurfaceModel's surface goes through the texture at pixel centres") {
  engine::RenderingOptions options = unlimited();
  options.filter_mm = 0.0;
  const Plane<double> texture = random_texture(8, 11, 4);
  const engine::TextureField field = engine::make_texture_field(texture, options);
  const engine::SurfaceModel model(field.view(), options, kGains);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 11; ++x) {
      const Vec2 at_mm = field.view().geometry.to_mm(x, y);
      const double force_n = still_force_n(model, {at_mm.x, at_mm.y, -2.0}).z;
      REQUIRE(force_n == Approx(0.4 * (2.0 + 0.004 * texture.at(y, x))).margin(1e-7));
    }
  }
}

TEST_CASE("SurfaceModel is a Hooke wall on a flat texture, without gain and without a field") {
  const engine::TextureField flat = flat_surface(20, 20);
  const engine::TextureField rough = random_surface(20, 20, 5);
  for (const engine::SurfaceModel& model :
       {engine::SurfaceModel(flat.view(), surface_options(), kGains),
        engine::SurfaceModel(rough.view(), surface_options(), {}),
        engine::SurfaceModel(random_field(20, 20, 5).view(), surface_options(), kGains),
        engine::SurfaceModel({}, surface_options(), kGains)}) {
    CHECK(still_force_n(model, {2.0, 2.0, -1.5}) == Vec3{0.0, 0.0, 0.4 * 1.5});
    CHECK(still_force_n(model, {2.0, 2.0, 0.0}) == Vec3{});
    CHECK(still_force_n(model, {2.0, 2.0, 3.0}) == Vec3{});
  }
}

TEST_CASE("SurfaceModel fades beyond the edge and is the flat wall beyond its rim") {
  const engine::TextureField field = random_surface(20, 30, 6);
  const engine::SurfaceModel model(field.view(), surface_options(), kGains);
  for (const double beyond_mm : {-engine::kRimMm, -50.0, 6.0 + engine::kRimMm, 1e9, 1e300}) {
    CHECK(still_force_n(model, {beyond_mm, 1.0, -1.0}) == Vec3{0.0, 0.0, 0.4});
    CHECK(still_force_n(model, {beyond_mm, beyond_mm, -1.0}) == Vec3{0.0, 0.0, 0.4});
  }
  CHECK(still_force_n(model, {-0.5, 1.0, -1.0}).z != 0.4);
}

TEST_CASE("SurfaceModel's force is continuous across the plane's edges and the rim's") {
  const engine::TextureField field = random_surface(10, 10, 7, 60.0);
  const engine::SurfaceModel model(field.view(), unlimited(), kGains);
  constexpr double kStepMm = 1e-4;
  constexpr double kSteepestNPerMm = 10.0;
  double steepest = 0.0;
  Vec3 before = still_force_n(model, {-3.0, 1.0, -2.0});
  for (double t = -3.0 + kStepMm; t < 5.0; t += kStepMm) {
    const Vec3 force_n = still_force_n(model, {t, 1.0 + 0.4 * t, -2.0});
    steepest = std::max(steepest, norm(force_n - before) / kStepMm);
    before = force_n;
  }
  CHECK(steepest > 0.01);
  CHECK(steepest < kSteepestNPerMm);
}

TEST_CASE("SurfaceModel's damping slows a hand, never pulls it and leaves the lateral force") {
  const engine::TextureField field = random_surface(20, 20, 8);
  engine::RenderingOptions options = unlimited();
  options.damping_n_s_per_mm = 0.002;
  const engine::SurfaceModel model(field.view(), options, kGains);
  const Vec3 at_mm{1.77, 2.31, -1.0};
  const Vec3 elastic_n = still_force_n(model, at_mm);
  engine::Bristle bristle;
  const auto moving_n = [&](double up_mm_s) {
    return model.force_n(at_mm, {30.0, -20.0, up_mm_s}, bristle);
  };
  CHECK(moving_n(50.0).z == Approx(elastic_n.z - 0.1));
  CHECK(moving_n(-50.0).z == Approx(elastic_n.z + 0.1));
  CHECK(moving_n(1000.0).z == 0.0);
  CHECK(moving_n(1000.0).x == elastic_n.x);
  CHECK(moving_n(1000.0).y == elastic_n.y);
  CHECK(model.force_n({1.0, 1.0, 2.0}, {0.0, 0.0, -500.0}, bristle) == Vec3{});
}

TEST_CASE("SurfaceModel does not read the field above the reach of any surface") {
  std::vector<float> coefficients(100, 0.0F);
  const engine::FieldView view{.geometry = {0.2, 10, 10},
                               .model = engine::ModelKind::surface,
                               .heights = coefficients,
                               .highest = 10.0};
  const engine::SurfaceModel model(view, surface_options(), {.height_mm = 0.01});
  std::ranges::fill(coefficients, 1e6F);
  CHECK(still_force_n(model, {1.0, 1.0, 0.1}) == Vec3{});
  CHECK(still_force_n(model, {1.0, 1.0, 0.0999}).z == Approx(3.3));
}

TEST_CASE("SurfaceModel limits the norm of the force and keeps its direction") {
  const engine::TextureField field = random_surface(10, 10, 9, 100.0);
  const engine::Gains strong{.height_mm = 0.02};
  const engine::SurfaceModel limited(field.view(), surface_options(), strong);
  const engine::SurfaceModel free(field.view(), unlimited(), strong);
  const double depth_mm = GENERATE(2.0, 8.0, 20.0, 1e6);
  RandomStream random(10, "points");
  for (int i = 0; i < 200; ++i) {
    const Vec3 at{random.uniform(0.0, 2.0), random.uniform(0.0, 2.0), -depth_mm};
    const Vec3 full_n = still_force_n(free, at);
    const Vec3 force_n = still_force_n(limited, at);
    REQUIRE(norm(force_n) <= 3.3 * (1.0 + 1e-15));
    REQUIRE(norm(force_n - std::min(1.0, 3.3 / norm(full_n)) * full_n) < 1e-9);
  }
}

TEST_CASE("SurfaceModel gives zero force for positions and velocities that are not finite") {
  const engine::TextureField field = random_surface(10, 10, 11);
  engine::RenderingOptions options = surface_options();
  options.friction = GENERATE(0.0, 0.5);
  const engine::SurfaceModel model(field.view(), options, kGains);
  const double bad = GENERATE(std::nan(""), kInfinity, -kInfinity);
  engine::Bristle bristle;
  for (const Vec3 where : {Vec3{bad, 1.0, -1.0}, Vec3{1.0, bad, -1.0}, Vec3{1.0, 1.0, bad}}) {
    CHECK(model.force_n(where, {}, bristle) == Vec3{});
  }
  for (const Vec3 speed : {Vec3{bad, 0.0, 0.0}, Vec3{0.0, bad, 0.0}, Vec3{0.0, 0.0, bad}}) {
    CHECK(model.force_n({1.0, 1.0, -1.0}, speed, bristle) == Vec3{});
  }
  CHECK(is_finite(model.force_n({1.0, 1.0, -1.0}, {}, bristle)));
  CHECK(model.force_n({1.0, 1.0, -1.0}, {}, bristle).z > 0.0);
}

TEST_CASE("SurfaceModel stays finite and within its limit whatever the gain, field and place") {
  const float odd = GENERATE(1e-30F, 1.0F, 1e30F, std::numeric_limits<float>::quiet_NaN(),
                             std::numeric_limits<float>::infinity());
  const double gain = GENERATE(0.0, 1e-12, 1.0, 1e12);
  engine::RenderingOptions options = surface_options();
  options.friction = GENERATE(0.0, 10.0);
  std::vector<float> coefficients(12, 1.0F);
  coefficients[5] = odd;
  const int height = GENERATE(1, 3, 12);
  const engine::FieldView view{{0.2, height, 12 / height}, {}, coefficients};
  const engine::SurfaceModel model(view, options, {.height_mm = gain});
  RandomStream random(12, "points");
  engine::Bristle bristle;
  for (int i = 0; i < 100; ++i) {
    Vec3 at_mm = random_point(random, view.geometry);
    if (i % 10 == 0) at_mm = 1e200 * at_mm;
    const Vec3 force_n = model.force_n(at_mm, {}, bristle);
    REQUIRE(is_finite(force_n));
    REQUIRE(norm(force_n) <= 3.3 * (1.0 + 1e-12));
  }
}

constexpr double kStiffness = 0.28;

TEST_CASE("a bristle holds like a spring and slips at its limit") {
  engine::Bristle bristle;
  CHECK(bristle.friction_n({3.0, 4.0}, 0.1, kStiffness) == Vec2{});
  const Vec2 held = bristle.friction_n({3.1, 4.0}, 0.1, kStiffness);
  CHECK(held.x == Approx(-0.028));
  CHECK(held.y == 0.0);
  CHECK(bristle.friction_n({3.1, 4.0}, 0.1, kStiffness) == held);
  const Vec2 slipping = bristle.friction_n({9.0, 4.0}, 0.1, kStiffness);
  CHECK(slipping.x == Approx(-0.1).epsilon(1e-12));
  CHECK(bristle.friction_n({9.0 - 2.0 * 0.1 / kStiffness, 4.0}, 0.1, kStiffness).x ==
        Approx(0.1).epsilon(1e-9));
}

TEST_CASE("a bristle is released without load, and anchored again after a release") {
  engine::Bristle bristle;
  static_cast<void>(bristle.friction_n({0.0, 0.0}, 1.0, kStiffness));
  CHECK(bristle.friction_n({1.0, 0.0}, 1.0, kStiffness).x == Approx(-0.28));
  CHECK(bristle.friction_n({1.0, 0.0}, 0.05, kStiffness).x == Approx(-0.05));
  CHECK(bristle.friction_n({1.0, 0.0}, 1.0, kStiffness).x == Approx(-0.05));
  CHECK(bristle.friction_n({1.0, 0.0}, 0.0, kStiffness) == Vec2{});
  static_cast<void>(bristle.friction_n({2.0, 0.0}, 1.0, kStiffness));
  bristle.release();
  CHECK(bristle.friction_n({5.0, 5.0}, 1.0, kStiffness) == Vec2{});
}

TEST_CASE("a bristle is passive for any path and load") {
  RandomStream random(GENERATE(1, 2, 3), "strokes");
  engine::Bristle bristle;
  Vec2 at_mm;
  double given_mj = 0.0;  // by the hand, so far
  static_cast<void>(bristle.friction_n(at_mm, 1.0, kStiffness));
  for (int i = 0; i < 20000; ++i) {
    const double size_mm = std::pow(10.0, random.uniform(-4.0, 1.0));
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vec2 step_mm = size_mm * Vec2{std::cos(angle), std::sin(angle)};
    at_mm = at_mm + step_mm;
    const Vec2 force_n = bristle.friction_n(at_mm, random.uniform(0.0, 0.5), kStiffness);
    given_mj -= force_n.x * step_mm.x + force_n.y * step_mm.y;
    const double stored_mj = 0.5 * (force_n.x * force_n.x + force_n.y * force_n.y) / kStiffness;
    REQUIRE(given_mj >= stored_mj - 1e-9);
  }
  CHECK(given_mj > 1.0);
}

TEST_CASE("friction depends on the path and not on how it is cut into ticks") {
  const auto last_force_n = [](int steps) {
    engine::Bristle bristle;
    Vec2 force_n;
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      force_n = bristle.friction_n({5.0 * t, 2.0 * t}, 0.2 * (1.0 + t), kStiffness);
    }
    return force_n;
  };
  const Vec2 fine_n = last_force_n(100000);
  CHECK(norm(fine_n) == Approx(0.4).epsilon(1e-9));
  CHECK(norm(last_force_n(50) - fine_n) < 1e-6);
}

TEST_CASE("SurfaceModel without friction does not depend on the bristle's state") {
  const engine::TextureField field = random_surface(20, 20, 1);
  const engine::SurfaceModel model(field.view(), surface_options(), {.height_mm = 0.004});
  engine::Bristle used;
  static_cast<void>(used.friction_n({50.0, 50.0}, 10.0, kStiffness));
  engine::Bristle fresh;
  RandomStream random(2, "points");
  for (int i = 0; i < 300; ++i) {
    const Vec3 at_mm{random.uniform(0.0, 4.0), random.uniform(0.0, 4.0), random.uniform(-2.0, 0.1)};
    REQUIRE(model.force_n(at_mm, {}, used) == model.force_n(at_mm, {}, fresh));
  }
}

TEST_CASE("SurfaceModel's friction holds a still hand, and pulls mu F_N on a sliding one") {
  engine::RenderingOptions options = surface_options();
  options.friction = 0.3;
  const engine::TextureField field = flat_surface(200, 200);
  const engine::SurfaceModel model(field.view(), options, {});
  engine::Bristle bristle;
  static_cast<void>(model.force_n({10.0, 10.0, -2.0}, {}, bristle));
  const Vec3 held_n = model.force_n({10.3, 10.0, -2.0}, {}, bristle);
  CHECK(held_n.x == Approx(-0.3 * 0.4 / std::numbers::sqrt2));
  for (int tick = 0; tick < 1000; ++tick) {
    REQUIRE(model.force_n({10.3, 10.0, -2.0}, {}, bristle) == held_n);
  }
  const Vec3 sliding_n = model.force_n({30.0, 10.0, -2.0}, {500.0, 0.0, 0.0}, bristle);
  CHECK(sliding_n.x == Approx(-0.3 * 0.8));
  CHECK(sliding_n.z == 0.8);
  CHECK(model.force_n({30.0, 10.0, 0.1}, {}, bristle) == Vec3{});
  CHECK(model.force_n({35.0, 10.0, -2.0}, {}, bristle).x == 0.0);
}

}  // namespace
}  // namespace touchtrial

#include "engine/rendering/bristle.hpp"

#include "core/random.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "engine/rendering/surface_model.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace touchtrial {
namespace {

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

TEST_CASE("a bristle lets go when the load goes, and takes hold anew after a release") {
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

TEST_CASE("a bristle gives no more energy than it got, whatever the path and the load") {
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

TEST_CASE("SurfaceModel without friction is the same to the bit whatever the bristle remembers") {
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

#include "engine/rendering/paper_model.hpp"

#include "engine/force_field.hpp"
#include "engine/reference/force_reference.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace touchtrial {
namespace {

constexpr engine::Gains kGains{0.012, 0.01};
constexpr Vec3 kStill{};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Plane<double> plane_of(std::span<const float> samples, const PlaneGeometry& geometry) {
  Plane<double> plane(geometry.height_px, geometry.width_px);
  std::ranges::copy(samples, plane.samples().begin());
  return plane;
}

/// The share of the lateral force at a load on the touchdown ramp, or beyond it.
double share_of(double load_n, double ramp_n) {
  return ramp_n == 0.0 ? 1.0 : std::min(1.0, load_n / ramp_n);
}

/// The force as docs/method.md has it, one equation after the other.
class PaperForce {
 public:
  /// Computes all force planes in double precision.
  PaperForce(engine::FieldView field, const engine::RenderingOptions& options, engine::Gains gains)
      : geometry_(field.geometry),
        options_(options),
        gains_(gains),
        heights_(plane_of(field.heights, geometry_)),
        force_(reference::tangential_force(plane_of(field.slopes(), geometry_),
                                           field.neighbourhood)) {}

  [[nodiscard]] Vec3 force_n(const Vec3& position_mm, const Vec3& velocity_mm_s) const {
    const auto [x, y, z] = position_mm;
    double elastic_n = options_.stiffness_n_per_mm * -z;
    Vec2 lateral;
    if (geometry_.contains(x, y)) {
      elastic_n += gains_.normal_n * (128.0 + at(heights_, x, y) - options_.reference_grey);
      lateral = {at(force_.x, x, y), at(force_.y, x, y)};
      if (options_.reference_grey == 0.0 && z >= 0.0) return {};
    }
    const double normal_n = elastic_n - options_.damping_n_s_per_mm * velocity_mm_s.z;
    const double load_n = std::min(elastic_n, normal_n);
    if (load_n <= 0.0) return {};
    const double tangential_n = gains_.tangential_n * share_of(load_n, options_.touchdown_ramp_n);
    const Vec3 force_n{tangential_n * lateral.x, tangential_n * lateral.y, normal_n};
    return std::min(1.0, options_.max_force_n / norm(force_n)) * force_n;
  }

 private:
  /// A value at every pixel, interpolated bilinearly.
  [[nodiscard]] double at(const Plane<double>& values, double x_mm, double y_mm) const {
    const Vec2 px = geometry_.to_px(x_mm, y_mm);
    double sum = 0.0;
    for (int y = -1; y <= values.height(); ++y) {
      for (int x = -1; x <= values.width(); ++x) {
        const double weight =
            std::max(0.0, 1.0 - std::abs(px.x - x)) * std::max(0.0, 1.0 - std::abs(px.y - y));
        const int row = std::clamp(y, 0, values.height() - 1);
        const int column = std::clamp(x, 0, values.width() - 1);
        sum += weight * values.at(row, column);
      }
    }
    return sum;
  }

  PlaneGeometry geometry_;
  engine::RenderingOptions options_;
  engine::Gains gains_;
  Plane<double> heights_;
  engine::ForceField<double> force_;
};

TEST_CASE("PaperModel agrees with its equations at every size, load, speed, ramp and gain") {
  const int height = GENERATE(1, 2, 3, 4, 7);
  const int width = GENERATE(1, 2, 3, 11);
  engine::RenderingOptions options{.filter_mm = 0.0,
                                   .neighbourhood = GENERATE(3, 5, 31),
                                   .touchdown_ramp_n = GENERATE(0.0, 1e-6, 0.2, 1.0)};
  const engine::TextureField field =
      engine::make_texture_field(random_texture(height, width, 3), options);
  const engine::FieldView view = field.view();
  RandomStream random(4, "points");
  options.damping_n_s_per_mm = GENERATE(0.0, 0.002);
  options.reference_grey = GENERATE(128.0, 140.0, 0.0);
  const engine::Gains gains = GENERATE(kGains, engine::Gains{});
  const engine::PaperModel model(view, options, gains);
  const PaperForce slow(view, options, gains);
  for (int i = 0; i < 200; ++i) {
    const Vec3 position_mm{random.uniform(-0.1, view.geometry.width_mm() + 0.1),
                           random.uniform(-0.1, view.geometry.height_mm() + 0.1),
                           random.uniform(-2.5, 0.5)};
    const Vec3 velocity_mm_s{random.uniform(-200.0, 200.0), 0.0, random.uniform(-200.0, 200.0)};
    const Vec3 force_n = model.force_n(position_mm, velocity_mm_s);
    const Vec3 expected = slow.force_n(position_mm, velocity_mm_s);
    CAPTURE(height, width, options.neighbourhood, options.touchdown_ramp_n, position_mm.x,
            position_mm.y, position_mm.z, velocity_mm_s.z);
    REQUIRE(norm(force_n - expected) < 1e-12);
  }
}

TEST_CASE("PaperModel with a touchdown ramp has no lateral step at landing and at lift-off") {
  const engine::TextureField field = random_field(10, 10, 18, 100.0);
  engine::RenderingOptions options{.damping_n_s_per_mm = 0.002};
  const double speed_mm_s = GENERATE(0.0, -50.0, 50.0);
  const auto largest_step_n = [&](double ramp_n) {
    options.touchdown_ramp_n = ramp_n;
    const engine::PaperModel model(field.view(), options, kGains);
    constexpr double kStepMm = 1e-5;
    double largest_n = 0.0;
    Vec3 before;
    for (double z = 1.0; z > -1.0; z -= kStepMm) {
      const Vec3 force_n = model.force_n({0.9, 1.1, z}, {0.0, 0.0, speed_mm_s});
      largest_n = std::max(largest_n, std::hypot(force_n.x - before.x, force_n.y - before.y));
      before = force_n;
    }
    return largest_n;
  };
  CHECK(largest_step_n(0.0) > 0.05);
  CHECK(largest_step_n(0.2) < 1e-4);
}

TEST_CASE("PaperModel takes the slopes of a sum of fields from their own plane") {
  const engine::TextureField one = random_field(12, 15, 20);
  const engine::TextureField other = random_field(12, 15, 21);
  // The gains of the two differ in their ratio, so that no single plane has both forces.
  const std::array<engine::FieldWithGains, 2> parts = {
      engine::FieldWithGains{one.view(), {0.01, 0.002}},
      engine::FieldWithGains{other.view(), {0.003, 0.004}}};
  const engine::TextureField sum = engine::sum_with_gains(parts);
  const engine::PaperModel both(sum.view(), {}, {1.0, 1.0});
  const engine::PaperModel first(one.view(), {}, parts[0].gains);
  const engine::PaperModel second(other.view(), {}, parts[1].gains);
  RandomStream random(5, "points");
  double offset_n = std::nan("");
  for (int i = 0; i < 200; ++i) {
    const Vec3 at{random.uniform(0.0, 3.0), random.uniform(0.0, 2.4), -2.0};
    const Vec3 expected = first.force_n(at, kStill) + second.force_n(at, kStill);
    const Vec3 force_n = both.force_n(at, kStill);
    REQUIRE(force_n.x == Approx(expected.x).margin(1e-6));
    REQUIRE(force_n.y == Approx(expected.y).margin(1e-6));
    if (i == 0) offset_n = expected.z - force_n.z;  // the second wall and the mean height
    REQUIRE(expected.z - force_n.z == Approx(offset_n).margin(1e-6));
  }
}

TEST_CASE("PaperModel does not read the field above the reach of any surface") {
  std::vector<float> heights(100);
  engine::FieldView view = view_of_heights(heights, 10, 10);
  view.highest = 0.0;
  const engine::PaperModel model(view, {}, kGains);
  for (float& height : heights) height = 1e6F;
  CHECK(model.force_n({1.0, 1.0, 0.1}, kStill) == Vec3{});
  CHECK(model.force_n({1.0, 1.0, -0.1}, kStill).z == Approx(3.3));
}

TEST_CASE("PaperModel limits the norm of the force and keeps its direction") {
  const engine::TextureField field = random_field(10, 10, 12, 100.0);
  engine::RenderingOptions unlimited{.max_force_n = 1e9};
  const engine::Gains strong{0.2, 0.01};
  const engine::PaperModel limited(field.view(), {}, strong);
  const engine::PaperModel free(field.view(), unlimited, strong);
  const double depth_mm = GENERATE(2.0, 8.0, 20.0, 1e6);
  RandomStream random(13, "points");
  for (int i = 0; i < 200; ++i) {
    const Vec3 at{random.uniform(0.0, 2.0), random.uniform(0.0, 2.0), -depth_mm};
    const Vec3 full_n = free.force_n(at, kStill);
    const Vec3 force_n = limited.force_n(at, kStill);
    const double scale = std::min(1.0, 3.3 / norm(full_n));
    REQUIRE(norm(force_n) <= 3.3 * (1.0 + 1e-15));
    REQUIRE(norm(force_n - scale * full_n) < 1e-9);
  }
}

TEST_CASE("PaperModel gives zero force for positions and velocities that are not finite") {
  const engine::TextureField field = random_field(10, 10, 14);
  const engine::PaperModel model(field.view(), {}, kGains);
  const double bad = GENERATE(std::nan(""), kInfinity, -kInfinity);
  CHECK(model.force_n({bad, 1.0, -1.0}, kStill) == Vec3{});
  CHECK(model.force_n({1.0, bad, -1.0}, kStill) == Vec3{});
  CHECK(model.force_n({1.0, 1.0, bad}, kStill) == Vec3{});
  CHECK(model.force_n({1.0, 1.0, -1.0}, {bad, 0.0, 0.0}) == Vec3{});
  CHECK(model.force_n({1.0, 1.0, -1.0}, {0.0, bad, 0.0}) == Vec3{});
  CHECK(model.force_n({1.0, 1.0, -1.0}, {0.0, 0.0, bad}) == Vec3{});
}

TEST_CASE("PaperModel never passes on samples that are not finite") {
  const float bad =
      GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
               -std::numeric_limits<float>::infinity());
  const std::vector<float> heights(9, bad);
  const engine::PaperModel model(view_of_heights(heights, 3, 3), {}, kGains);
  CHECK(model.force_n({0.3, 0.3, -1.0}, kStill) == Vec3{});
}

TEST_CASE("PaperModel of an empty field is the flat wall") {
  const engine::PaperModel model({}, {}, kGains);
  CHECK(model.force_n({0.0, 0.0, -1.0}, kStill) == Vec3{0.0, 0.0, 0.4});
}

}  // namespace
}  // namespace touchtrial
